#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "viewer/candidates.h"

namespace vantage {

/// A factor of one view.
struct FactorReading {
  double value = 0.0;
  std::string text;                  ///< with its unit: "1 234 rays"
  std::optional<double> share = {};  ///< length of its bar in [0, 1]; empty = a fact without a bar
  bool operator==(const FactorReading&) const = default;
};

/// One of the things that decide about a view, beside that of the view it is measured against.
struct ViewFactor {
  std::string name;                         ///< "gain"
  std::string about;                        ///< what it means
  std::optional<FactorReading> view = {};   ///< empty = see Explanation::missing
  std::optional<FactorReading> other = {};  ///< of Explanation::other
  std::optional<double> limit_share = {};   ///< where on the bar's scale the threshold is
  std::string limit = {};                   ///< "at least 700 rays"; empty without one
};

/// Why a view was chosen, or not.
struct Explanation {
  std::uint32_t id = 0;
  std::optional<CandidateRow> row =
      {};  ///< empty: its segment is not scored, or it is no candidate of the step
  /// The view that it is measured against: the chosen one, or for the chosen one that which would have been
  /// next. Empty if there is none.
  std::optional<std::uint32_t> other = {};
  bool is_winner = false;                ///< it is the chosen view
  std::string sentence = {};             ///< in plain words; never empty
  std::vector<ViewFactor> factors = {};  ///< empty for what is no candidate
  std::string missing = {};              ///< why a factor of the view has no value: "not scored yet"
};

/// Explains a candidate of the step that is shown.
Explanation explain(const SceneFrame& shown, std::uint32_t id);
/// The same with the step's rows at hand. \param rows candidateRows(shown), in any state of comparison
Explanation explain(const SceneFrame& shown, const std::vector<CandidateRow>& rows, std::uint32_t id);

/// All that countedVoxels() depends on beside the map, the camera and the rays of the octree's planner.
struct CountedRegion {
  Pose T_world_camera = Pose::Identity();
  std::optional<Sphere> sphere = {};  ///< only voxels inside count
  Box bounds;                         ///< the same; empty = no such limit
  OutsideUnknown outside = OutsideUnknown::Opaque;
  bool operator==(const CountedRegion& other) const;
};

/// Empty if the candidate's segment or position is not known.
std::optional<CountedRegion> countedRegion(const SceneFrame& shown, const CandidateRow& row);

/// Distinct unknown voxels that a candidate counts, at full resolution; the diagnostic
/// ChosenView::gain_voxels of any view. One cast. 0 if its segment or position is not known.
std::uint64_t countedVoxels(const SceneFrame& shown, const CandidateRow& row);
std::uint64_t countedVoxels(const SceneFrame& shown, const CountedRegion& region);

}  // namespace vantage
