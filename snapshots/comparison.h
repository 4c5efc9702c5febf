#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/run_control.h"

namespace vantage {

/// Which pictures of two runs are set side by side.
struct ComparisonRequest {
  std::optional<int> step;  ///< one step, SnapshotRequest::kEnd = the map after the last scan; empty = all
  std::vector<std::string> recipes;  ///< names or files (recipeFrom()); empty = states and views
  std::vector<std::string> style;    ///< settings for all recipes, each KEY=VALUE, see setStyle()
  /// A file name ending in .png, or a folder, where the file is `RUN_A-RUN_B.png`. Further pages get `-2`,
  /// ...
  std::string output;
};

/// One contact sheet of two runs of one scene: a row a step, per recipe a column of each run. A step that one
/// of them lacks stays blank there. Returns the files written, one a page of ContactSheet::kMostRows rows.
/// \throws InputError if the runs are not about one scene, or the request can't be met; GlUnavailable,
/// std::runtime_error naming a file that can't be written, Cancelled.
std::vector<std::filesystem::path> takeComparison(const std::filesystem::path& run_a,
                                                  const std::filesystem::path& run_b,
                                                  const ComparisonRequest& request,
                                                  const RunControl& control = {});

}  // namespace vantage
