#pragma once

#include <filesystem>

#include "core/geometry/camera_model.h"
#include "core/geometry/depth_image.h"
#include "core/geometry/pose.h"
#include "io/config_file.h"
#include "io/error.h"

namespace vantage {

/// Refuses a folder with something in it, before work is spent on a recording. \throws InputError
void requireEmptyFolder(const std::filesystem::path& folder);

/// Records depth frames with poses as a data set that openDataset() reads: `frame-NUMBER.depth.png` in whole
/// millimetres, `frame-NUMBER.pose.txt`, and `dataset.toml`. Beside them `config.toml`, the settings of the
/// session: with them the frames fuse to the same map again. A frame is complete or absent, whenever the
/// program ends.
class DatasetWriter {
 public:
  /// Makes the folder. \throws InputError if there is something in it, or it can't be written
  DatasetWriter(const std::filesystem::path& folder, const PinholeCamera& camera, const Settings& settings);

  /// A frame as the data set holds it: what was written, read again.
  struct Frame {
    DepthImage depth;
    Pose T_world_camera = Pose::Identity();
  };
  /// \throws InputError if it can't be written
  Frame append(const DepthImage& depth, const Pose& T_world_camera);

 private:
  std::filesystem::path folder_;
  int count_ = 0;
};

}  // namespace vantage
