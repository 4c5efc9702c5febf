#include "io/dataset_writer.h"

#include "io/dataset_parts.h"
#include "io/depth_png.h"
#include "io/text_file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

std::string describe(const PinholeCamera& camera, int observations_per_frame) {
  return "# Depth in whole millimetres, poses camera to world.\n"
         "observations_per_frame = " +
         std::to_string(observations_per_frame) + "\n" + "range_m = [" + shortestNumber(camera.min_range_m) +
         ", " + shortestNumber(camera.max_range_m) + "]\n\n" + "[camera]\nfx = " + shortestNumber(camera.fx) +
         "\nfy = " + shortestNumber(camera.fy) + "\ncx = " + shortestNumber(camera.cx) +
         "\ncy = " + shortestNumber(camera.cy) + "\n";
}

std::string poseText(const Pose& pose) {
  std::string text;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) text += shortestNumber(pose.matrix()(r, c)) + (c < 3 ? " " : "\n");
  return text;
}

}  // namespace

void requireEmptyFolder(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error)) return;
  if (!fs::is_directory(folder, error))
    throw InputError(folder.string(), "is no folder; choose another name");
  if (!fs::is_empty(folder, error))
    throw InputError(folder.string(), "there is something in it; a recording wants a folder of its own");
}

DatasetWriter::DatasetWriter(const fs::path& folder, const PinholeCamera& camera, const Settings& settings)
    : folder_(folder) {
  requireEmptyFolder(folder);
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) throw InputError(folder.string(), "is no folder and cannot be made one");
  saveFile(folder / "dataset.toml", describe(camera, settings.exploration.fusion.observations_per_frame));
  saveFile(folder / "config.toml", effectiveToml(settings));
}

DatasetWriter::Frame DatasetWriter::append(const DepthImage& depth, const Pose& T_world_camera) {
  std::string number = std::to_string(count_);
  number.insert(0, number.size() < 6 ? 6 - number.size() : 0, '0');
  const fs::path pose = folder_ / ("frame-" + number + ".pose.txt"),
                 image = folder_ / ("frame-" + number + ".depth.png"), unfinished = folder_ / "frame.part";
  saveFile(pose, poseText(T_world_camera));
  writeDepthPng(unfinished, depth);
  std::error_code error;
  fs::rename(unfinished, image, error);  // an image is what makes a frame one
  if (error) throw InputError(image.string(), "cannot be written: " + error.message());
  ++count_;
  return {readDepthPng(image), dataset::readPoseFile(pose)};
}

}  // namespace vantage
