#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/perception/contours.h"
#include "core/perception/saliency.h"
#include "core/planners/view_choice.h"
#include "core/raycasting/uniform_caster.h"
#include "core/run_control.h"
#include "core/views/contour_views.h"

namespace vantage {

/// What the gain of a pose counts (D-B7, D-B8).
enum class GainMeasure {
  Rays,    ///< rays whose first voxel that is not free is unknown and in the region
  Voxels,  ///< those voxels, each once
  Volume   ///< every unknown voxel of the region before the first occupied one, each once: rays go through it
};

/// Scoring and selection (sections 2 and 8).
struct GainConfig {
  double sphere_margin_m = 0.20;  ///< added to the segment's radius, metres, >= 0
  double gain_threshold = 700.0;  ///< rays at full resolution (D-B12), or voxels
  /// 1/reduction of the resolution per axis; gains in rays are scaled by its square (D-B11), those in voxels
  /// are what the rays that were cast meet.
  int reduction = 4;
  GainMeasure count = GainMeasure::Rays;
  OutsideUnknown outside = OutsideUnknown::Opaque;  ///< D-B9; no matter for GainMeasure::Volume
  bool exclude_executed = true;                     ///< D-B15
  double executed_distance_m = 0.05;                ///< D-B15, metres
  double executed_angle_rad = 0.17453292519943295;  ///< D-B15, radians; 10 deg
  bool exclude_disappointing = false;               ///< D-B33
  double disappointing_share = 0.10;                ///< realised / predicted below which D-B33 strikes
  double disappointing_distance_m = 0.05;           ///< D-B33, metres
  bool operator==(const GainConfig&) const = default;
  /// Gain of one unknown ray or voxel that is counted.
  double perUnknown() const { return count == GainMeasure::Rays ? double(reduction) * reduction : 1.0; }
  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// Everything that steers the contour planner, stage by stage.
struct ContourPlannerConfig {
  ContourConfig contours;
  ContourViewConfig views;
  SegmentationConfig segmentation;
  SaliencyConfig saliency;
  GainConfig gain;
  bool segment_by_segment =
      true;  ///< false: the standard baseline, every pose over the whole workspace (D-B16)
  /// Checks every part. \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// Everything known about one scored pose.
struct PoseScore {
  std::uint32_t id = 0;        ///< candidate id
  double gain = 0.0;           ///< in the measure's unit; rays: `unknown` x reduction^2, voxels: `unknown`
  std::uint32_t unknown = 0;   ///< rays cast that end on unknown in the sphere (or workspace), or its voxels
  std::uint32_t occupied = 0;  ///< rays cast that end on occupied inside it
  Reachability reachability = Reachability::NotChecked;
  bool executed_before = false;  ///< excluded by D-B15
  std::int32_t histogram = -1;   ///< index into SegmentSearch::histograms, -1 = none
};

/// What the search did with one segment (lines 7-17 of Algorithm 1).
struct SegmentSearch {
  std::int32_t segment =
      -1;  ///< index into Saliency::segments; -1 = points without a segment (D-B13) or the baseline
  double saliency = 0.0;
  /// Region whose unknown counts: the segment's bounding sphere (D-B13: that of its contour points) plus the
  /// margin. Radius 0 for the baseline: its region is the workspace.
  Sphere sphere;
  std::vector<std::uint32_t> contour_points;
  std::uint32_t poses_generated = 0;
  bool scored = false;            ///< false: the search ended before this segment
  std::vector<PoseScore> scores;  ///< by decreasing gain, ties to the lowest id; empty if not scored
  /// Per distinct cast: first-hit unknown rays by distance to the sphere centre, bins of kHistogramWidth_m
  /// from the bounding sphere's radius outward, without the margin (bin 0: inside the radius). With opaque
  /// outside, `unknown` under a margin of k bins is the sum of bins 0..k. Poses rolled by half a turn share
  /// one. None for the baseline and for gains in voxels.
  std::vector<std::vector<std::uint32_t>> histograms;
};
inline constexpr int kHistogramBins = 52;
inline constexpr double kHistogramWidth_m = 0.01;
inline constexpr double kLargestKeptMargin_m = 0.50;  ///< the histograms answer for margins up to here

/// The number of histogram bins that a sphere margin spans, empty unless it is a whole number of them (up to
/// rounding) and at most kLargestKeptMargin_m.
std::optional<int> marginBins(double sphere_margin_m);

/// The next best view and where it came from.
struct ContourChosenView : ChosenView {
  std::uint32_t contour_point = 0;
  std::uint32_t search = 0;  ///< index into ViewSearch::segments
  std::uint32_t rank = 0;    ///< position in that segment's scores
};

/// Result of the evaluation stage.
struct ViewSearch {
  std::vector<SegmentSearch>
      segments;  ///< in the order in which they are tried; all with contour points, also those not reached
  std::optional<ContourChosenView> chosen;
  SearchCounts counts;
  double evaluation_s = 0.0;       ///< ray casting and ranking, without the diagnostic `gain_voxels`
  double motion_planning_s = 0.0;  ///< reachability
};

/// Contour points of each segment: the segment of the nearest point of the whole cloud (line 8). Result: one
/// label per contour point, 0 = nearest cloud point has no label, or there is no cloud. Equally near points:
/// the lowest index decides. \throws std::invalid_argument unless there is one label per cloud point.
std::vector<std::uint32_t> assignContourPoints(const std::vector<ContourPoint>& points,
                                               const SurfaceCloud& cloud, const Labels& labels);

/// Input of the search: the products of the earlier stages.
struct ViewSearchInput {
  const StateGrid& states;
  const PinholeCamera& camera;
  const Box& workspace;  ///< limits the baseline's gain
  const std::vector<ContourPoint>& points;
  const std::vector<ViewPosition>& positions;
  const std::vector<std::uint32_t>& point_labels;  ///< assignContourPoints(); ignored by the baseline
  const Saliency& saliency;                        ///< ignored by the baseline
  std::span<const Pose> executed;                  ///< poses taken so far (D-B15)
  std::span<const Eigen::Vector3d> disappointing;  ///< contour points not to be offered again (D-B33)
};

/// Algorithm 1, lines 6-17: segments by decreasing saliency, poses by decreasing gain, the first one above
/// the threshold that can be reached. With segment_by_segment off: the standard baseline. A position that was
/// found out of reach, in collision or without a path is not asked for again with another roll. \throws
/// Cancelled when a stop is requested; std::invalid_argument for a config out of range or inputs that don't
/// belong together.
ViewSearch searchView(const ViewSearchInput& input, const ContourPlannerConfig& config,
                      const ReachPose& reach, const RunControl& control);

/// Scores all poses of one group of contour points without regard to threshold or reachability: reads
/// `segment` and `contour_points` of `search`, fills the rest of it and adds the work to `counts`.
void scoreSegment(const ViewSearchInput& input, const ContourPlannerConfig& config, SegmentSearch& search,
                  SearchCounts& counts, const RunControl& control);

/// Distinct first-hit unknown voxels inside the group's region that a pose sees at full resolution: the
/// diagnostic ChosenView::gain_voxels. One cast, a few milliseconds.
std::uint64_t countVoxels(const ViewSearchInput& input, const ContourPlannerConfig& config,
                          const SegmentSearch& search, const Pose& T_world_camera);

}  // namespace vantage
