#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/run_control.h"
#include "io/run_file.h"

namespace vantage {

/// Which pictures of two runs are set side by side.
struct ComparisonRequest {
  std::optional<int> step;  ///< one step, SnapshotRequest::kEnd = the map after the last scan; empty = all
  std::vector<std::string> recipes;  ///< names or files (recipeFrom()); empty = states and views
  std::vector<std::string> style;    ///< settings for all recipes, each KEY=VALUE, see setStyle()
  /// A file name ending in .png in a folder that exists, or a folder, where the file is `RUN_A-RUN_B.png`.
  /// Further pages get `-2`, ...
  std::string output;
};

/// What the map is that a run measures: the TSDF, or the octree of a run that has no other.
struct MeasuredMap {
  const char* kind = "TSDF";  ///< or "octree"
  double voxel_size_m = 0.0;
};
MeasuredMap measuredMap(const RunHeader& header);

/// Refuses runs that are not about one scene: the same input, however its path is spelt, and the same ground
/// truth. \param paths of the runs, for messages. \throws InputError
void requireOneScene(const std::vector<std::string>& paths, const std::vector<RunHeader>& headers);

/// What besides the planner makes the figures of runs differ, one sentence each: the map that is measured,
/// its voxel size, the seed. Runs are numbered from 1.
std::vector<std::string> differencesOf(const std::vector<RunHeader>& headers);

/// One contact sheet of two runs of one scene: a row a step, per recipe a column of each run. A step that one
/// of them lacks stays blank there; where
/// differencesOf() is not empty, the columns say how each run is measured. Returns the files written, one a
/// page of ContactSheet::kMostRows rows. \throws InputError if the runs are not about one scene, or the
/// request can't be met; GlUnavailable, std::runtime_error naming a file that can't be written, Cancelled.
std::vector<std::filesystem::path> takeComparison(const std::filesystem::path& run_a,
                                                  const std::filesystem::path& run_b,
                                                  const ComparisonRequest& request,
                                                  const RunControl& control = {});

}  // namespace vantage
