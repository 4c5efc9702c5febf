#include "io/dataset.h"

#include <fstream>

#include "io/bag_dataset.h"
#include "io/dataset_parts.h"
#include "io/text_file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using dataset::Description;

constexpr double kNearest_m = 0.1, kFarthest_m = 8.0;

/// Intrinsics in the order stated in the header; looks beside the frames and above them.
PinholeCamera findIntrinsics(const fs::path& folder, const Description& description, Dataset& result) {
  if (description.camera) return *description.camera;
  if (description.intrinsics_file) return dataset::readIntrinsics(folder / *description.intrinsics_file);
  const fs::path beside = result.frames.front().depth_path.parent_path();
  for (const fs::path& place : {beside, beside.parent_path(), folder}) {
    std::error_code error;
    if (fs::exists(place / "camera-intrinsics.txt", error))
      return dataset::readIntrinsics(place / "camera-intrinsics.txt");
  }
  if (result.layout != "tum")
    throw InputError((folder / "camera-intrinsics.txt").string(),
                     "is missing; it holds a 3x3 matrix or fx fy cx cy");
  PinholeCamera camera;
  camera.fx = camera.fy = 525.0, camera.cx = 319.5, camera.cy = 239.5;
  result.warnings.push_back(folder.string() +
                            ": no camera-intrinsics.txt; taking fx = fy = 525, cx = 319.5, cy = 239.5");
  return camera;
}

/// All images have the size of the first, which becomes the camera's.
void readSizes(Dataset& result) {
  const ImageSize first = depthPngSize(result.frames.front().depth_path);
  for (const DatasetFrame& frame : result.frames) {
    const ImageSize size = depthPngSize(frame.depth_path);
    if (size == first) continue;
    throw InputError(frame.depth_path.string(),
                     "is " + std::to_string(size.width) + "x" + std::to_string(size.height) +
                         "; the first frame is " + std::to_string(first.width) + "x" +
                         std::to_string(first.height) + ", all must be of one size");
  }
  result.camera.width = first.width;
  result.camera.height = first.height;
}

std::string layoutOf(const fs::path& folder, const Description& description) {
  if (description.layout) return *description.layout;
  if (!description.depth_pattern.empty() || !dataset::frameFolder(folder).empty()) return "frames";
  if (dataset::isTum(folder)) return "tum";
  throw InputError(folder.string(),
                   "is no data set: neither frame-NUMBER.depth.png (here or in frames/) nor depth.txt with "
                   "groundtruth.txt; describe it in a dataset.toml");
}

void validateCamera(const fs::path& folder, const PinholeCamera& camera) {
  try {
    camera.validate();
  } catch (const std::invalid_argument& error) {
    throw InputError(folder.string(), error.what());
  }
}

bool isBag(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return false;
  if (path.extension() == ".bag") return true;
  constexpr std::string_view kMagic = "#ROSBAG V";
  if (!fs::is_regular_file(path, error)) return false;
  std::string head(kMagic.size(), '\0');
  return std::ifstream(path, std::ios::binary).read(head.data(), kMagic.size()) && head == kMagic;
}

/// What the description adds to the frames and their camera.
void complete(Dataset& dataset, const Description& description) {
  dataset.camera.min_range_m = description.min_range_m.value_or(kNearest_m);
  dataset.camera.max_range_m = description.max_range_m.value_or(kFarthest_m);
  validateCamera(dataset.path, dataset.camera);
  if (description.depth_unit_m) dataset.depth_format.unit_m = *description.depth_unit_m;
  if (description.invalid_depth) dataset.depth_format.invalid = *description.invalid_depth;
  dataset.observations_per_frame = description.observations_per_frame.value_or(10);
  placeDataset(dataset, description.T_world_dataset);
  dataset.bounds = description.bounds;
}

Dataset openFolder(const fs::path& path, const Description& description) {
  Dataset result;
  result.path = path;
  result.layout = layoutOf(path, description);
  const bool tum = result.layout == "tum";
  result.frames =
      tum ? dataset::listTumFrames(path, result.warnings) : dataset::listPatternFrames(path, description);
  if (description.world_to_camera)
    for (DatasetFrame& frame : result.frames) frame.T_world_camera = frame.T_world_camera.inverse();
  result.camera = findIntrinsics(path, description, result);
  readSizes(result);
  result.depth_format.unit_m = tum ? 0.0002 : 0.001;
  return result;
}

}  // namespace

bool isDatasetPath(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error) || isBag(path);
}

bool looksLikeDataset(const fs::path& path) {
  std::error_code error;
  if (isBag(path)) return fs::is_regular_file(path, error);
  return fs::is_directory(path, error) && (fs::exists(path / "dataset.toml", error) ||
                                           !dataset::frameFolder(path).empty() || dataset::isTum(path));
}

Dataset openDataset(const fs::path& path, const std::optional<fs::path>& toml) {
  std::error_code error;
  const bool bag = isBag(path);
  if (!bag && !fs::is_directory(path, error))
    throw InputError(path.string(), "is not a folder or .bag file; a data set is one");
  const fs::path beside = bag ? fs::path(path.string() + ".toml") : path / "dataset.toml";
  Description description;
  if (toml || fs::exists(beside, error))
    description = dataset::readDescription(toml.value_or(beside),
                                           bag ? dataset::Described::Bag : dataset::Described::Folder);
  Dataset result = bag ? dataset::openBag(path, description) : openFolder(path, description);
  complete(result, description);
  return result;
}

DepthImage loadDepth(const Dataset& dataset, std::size_t index) {
  const DatasetFrame& frame = dataset.frames.at(index);
  if (dataset.source) return dataset.source->load(frame.number, dataset.depth_format);
  DepthImage depth = readDepthPng(frame.depth_path, dataset.depth_format);
  if (depth.width != dataset.camera.width || depth.height != dataset.camera.height)
    throw InputError(frame.depth_path.string(), "is " + std::to_string(depth.width) + "x" +
                                                    std::to_string(depth.height) + "; the camera has " +
                                                    std::to_string(dataset.camera.width) + "x" +
                                                    std::to_string(dataset.camera.height));
  return depth;
}

void placeDataset(Dataset& dataset, const Pose& T_world_dataset) {
  const Pose T_new_old = T_world_dataset * dataset.T_world_dataset.inverse();
  for (DatasetFrame& frame : dataset.frames) frame.T_world_camera = T_new_old * frame.T_world_camera;
  dataset.T_world_dataset = T_world_dataset;
  dataset.bounds.reset();
}

}  // namespace vantage
