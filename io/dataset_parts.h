#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/dataset.h"

namespace vantage::dataset {

/// What `dataset.toml` or `NAME.bag.toml` says; absent = to be found out.
struct Description {
  std::optional<std::string> layout;
  std::string depth_pattern, color_pattern, pose_pattern;                  ///< empty = the layout's own
  std::optional<std::string> depth_topic, camera_info_topic, fixed_frame;  ///< of a bag
  std::optional<std::string> intrinsics_file;
  std::optional<PinholeCamera> camera;  ///< fx, fy, cx, cy
  std::optional<double> depth_unit_m;
  std::optional<std::vector<std::uint16_t>> invalid_depth;
  bool world_to_camera = false;
  std::optional<double> min_range_m, max_range_m;
  std::optional<int> observations_per_frame;
  Pose T_world_dataset = Pose::Identity();
  std::optional<Box> bounds;
};

/// What is described.
enum class Described { Folder, Bag };

/// \throws InputError FILE:LINE for broken TOML, unknown keys, wrong types and values out of range.
Description readDescription(const std::filesystem::path& path, Described what = Described::Folder);

/// A pose as 4x4 numbers. \throws InputError naming the file if it is missing, broken or not rigid.
Pose readPoseFile(const std::filesystem::path& path);

/// Frames of the two layouts in ascending number, poses in the data set's own frame as the files state them.
std::vector<DatasetFrame> listPatternFrames(const std::filesystem::path& folder,
                                            const Description& description);
std::vector<DatasetFrame> listTumFrames(const std::filesystem::path& folder,
                                        std::vector<std::string>& warnings);

/// Folder that holds `frame-*.depth.png`: the given one or its `frames/`; empty if neither does.
std::filesystem::path frameFolder(const std::filesystem::path& folder);
bool isTum(const std::filesystem::path& folder);

/// fx, fy, cx, cy from a 3x3 matrix or four numbers. \throws InputError naming file and line.
PinholeCamera readIntrinsics(const std::filesystem::path& path);

}  // namespace vantage::dataset
