#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/planners/view_choice.h"
#include "core/raycasting/hierarchical_caster.h"
#include "core/run_control.h"
#include "core/views/sphere_views.h"

namespace vantage {

enum class CandidateGenerator : std::uint8_t { Icosphere, Workspace };
enum class GainCount : std::uint8_t { Rays, Voxels };

/// Everything that steers the hierarchical planner (sections 3-8 of its specification).
struct HierarchicalPlannerConfig {
  RaySensor sensor;
  int coarse_levels = 2;  ///< m; 0 = uniform ray tracing
  ChildStart child_start = ChildStart::Resume;
  bool refine_unknown = false;        ///< D-A4
  GainCount count = GainCount::Rays;  ///< D-A4; Voxels needs refine_unknown or m = 0
  CandidateGenerator generator = CandidateGenerator::Icosphere;
  int icosphere_subdivisions = 2;  ///< 20 * 4^n views, 0..6
  double sphere_radius_m = 1.0;    ///< of the view sphere about the middle of the object's box, metres
  int workspace_views = 1500;      ///< views drawn in the workspace
  double body_m = 0.05;            ///< RBB: edge of the robot's cube, metres, >= 0 (D-A16)
  double min_occupied = 400.0;     ///< h_oc, rays (eq. 2)
  double min_overlap = 0.0;        ///< alternative to h_oc: occupied / (occupied + unknown), 0 = off (D-A15)
  double stop_gain = 100.0;        ///< h_stop, rays (D-A18)
  /// Views near one already taken are not offered again; the paper offers them, and a view whose unknown no
  /// scan resolves (shadows of the emitter, say) is then taken over and over.
  bool exclude_executed = false;
  double executed_distance_m = 0.05;                ///< how near, metres
  double executed_angle_rad = 0.17453292519943295;  ///< and how little turned, radians; 10 deg
  double rotation_weight_m_per_rad = 1.0;           ///< w of rho (D-A17), 0 = position only
  bool operator==(const HierarchicalPlannerConfig&) const = default;
  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// Why a candidate was dropped by the cascade (section 3).
enum class ViewRejection : std::uint8_t {
  None,
  Position,      ///< the robot's box is not free there, or the sensor stands in something (D-A12, D-A16)
  Registration,  ///< too little known surface in view (eq. 2)
  Executed,      ///< near a view that was taken before (exclude_executed)
};
/// `` (empty), `position`, `registration`, `executed`: as tables have it.
std::string_view tokenOf(ViewRejection rejection);

/// A candidate with every factor of eq. 1. Factors that the cascade never computed are 0.
struct ViewUtility {
  std::uint32_t id = 0;
  Pose T_world_camera = Pose::Identity();
  std::int32_t frame = -1;  ///< see ViewCandidate
  ViewRejection rejection = ViewRejection::None;
  Reachability reachability = Reachability::NotChecked;
  RayCounts rays;
  double unknown = 0.0;   ///< uno(v): rays or voxels, by config
  double occupied = 0.0;  ///< oco(v)
  double surface = 0.0;   ///< sur(v) = uno(v) / un_o (eq. 3); may exceed 1 in rays
  double distance = 0.0;  ///< dist(v) (eq. 5)
  double utility = 0.0;   ///< u(v) (eq. 1), 0 if rejected
};

/// Result of the evaluation stage of the hierarchical planner.
struct UtilitySearch {
  std::vector<ViewUtility> views;  ///< in the order of the candidates
  std::vector<std::uint32_t>
      ranking;  ///< indices of surviving views by decreasing utility, ties to the lower index
  std::optional<ChosenView> chosen;  ///< empty: no surviving view reaches h_stop, or none can be reached
  SearchCounts counts;
  std::uint64_t finest_rays_cast = 0;
  std::uint64_t rejected_position = 0;
  std::uint64_t rejected_registration = 0;
  std::uint64_t box_unknown = 0;   ///< un_o: unknown voxels in the object's box
  std::uint64_t box_occupied = 0;  ///< occupied voxels in it
  double best_unknown = 0.0;       ///< largest uno(v) of the survivors
  /// The literal rule (the view of the highest utility sees less than h_stop) would stop here (D-A18).
  bool literal_stop = false;
  double evaluation_s = 0.0;       ///< cascade and ranking, without the diagnostic gain_voxels
  double motion_planning_s = 0.0;  ///< reachability
};

/// Factors of the chosen view, null if there is none.
const ViewUtility* chosenUtility(const UtilitySearch& search);

/// How a search ended.
enum class SearchEnd : std::uint8_t {
  Chosen,
  NoSurvivor,     ///< the cascade dropped every candidate
  LittleUnknown,  ///< no survivor sees `stop_gain` (D-A18)
  Unreachable,    ///< the robot can take none of the survivors that would show something
};
/// \param stop_gain h_stop of the search
SearchEnd endOf(const UtilitySearch& search, double stop_gain);

struct UtilityInput {
  const StatePyramid& pyramid;
  const RayTree& tree;
  const Box& object_box;
  const std::vector<ViewCandidate>& candidates;
  const Pose& current;                  ///< p.q of eq. 5
  std::span<const Pose> executed = {};  ///< views taken so far
};

/// How the rays of a candidate are cast and counted.
HierarchicalQuery queryOf(const Box& object_box, const HierarchicalPlannerConfig& config);

/// True if every voxel that the cube of edge `body_m` about `center_world` overlaps is free; outside the map
/// nothing is (D-A16).
bool bodyFits(const StateGrid& states, const Eigen::Vector3d& center_world, double body_m);

/// rho (D-A17): sqrt(|dx|^2 + (w dtheta)^2).
double configurationDistance(const Pose& a, const Pose& b, double rotation_weight_m_per_rad);

/// Step 4 of Algorithm 1 for one candidate: pos -> rays -> reg -> sur * dist (eq. 1-5).
/// \param box_unknown un_o
ViewUtility evaluateView(const UtilityInput& input, const HierarchicalPlannerConfig& config,
                         const ViewCandidate& candidate, std::uint64_t box_unknown);

/// Steps 4 and 5 of Algorithm 1 for all candidates, in parallel: the reachable view of the highest utility
/// among those that survive; none if no survivor reaches h_stop (D-A18).
/// \throws Cancelled; std::invalid_argument for a config out of range or inputs that don't belong together.
UtilitySearch searchUtility(const UtilityInput& input, const HierarchicalPlannerConfig& config,
                            const ReachPose& reach, const RunControl& control);

/// Distinct first-hit unknown voxels of the object's box that a pose sees by uniform rays: the diagnostic
/// ChosenView::gain_voxels.
std::uint64_t countVoxels(const UtilityInput& input, const Pose& T_world_camera);

/// Candidates by the configured generator. \param workspace where positions are drawn
std::vector<ViewCandidate> makeCandidates(const HierarchicalPlannerConfig& config, const Box& object_box,
                                          const Box& workspace, std::uint64_t seed);

}  // namespace vantage
