#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/camera_model.h"
#include "core/geometry/depth_image.h"
#include "core/geometry/grid_geometry.h"
#include "core/geometry/pose.h"
#include "io/config_file.h"
#include "io/depth_png.h"
#include "io/error.h"

namespace vantage {

/// One recorded frame.
struct DatasetFrame {
  int number = 0;  ///< as in the file's name, or position in the list (TUM RGB-D) or topic (ROS)
  std::filesystem::path depth_path;  ///< empty if the data set has a source
  std::filesystem::path color_path;  ///< empty if there is none
  Pose T_world_camera = Pose::Identity();
};

/// Depth images that are no PNG files. Safe to use from several threads.
class DepthSource {
 public:
  virtual ~DepthSource() = default;
  /// Depth of the frame with this number, metres. \throws InputError if the image is damaged.
  virtual DepthImage load(int number, const DepthPngFormat& format) const = 0;
};

/// A recorded RGB-D sequence with poses. Images are read when asked for.
///
/// Layouts that are recognised, where `dataset.toml` does not say otherwise:
/// - 7-Scenes style: `frame-NUMBER.depth.png` and `frame-NUMBER.pose.txt` (4x4, camera to world) in the
/// folder or in
///   its `frames/`; `camera-intrinsics.txt` (3x3 matrix, or fx fy cx cy) beside them or above. Millimetres.
/// - TUM RGB-D: `depth.txt`, `groundtruth.txt`, optionally `rgb.txt`; nearest time stamps within 0.02 s;
/// counts of
///   0.2 mm. Without `camera-intrinsics.txt`: 525, 525, 319.5, 239.5, with a warning.
///
/// - A file `NAME.bag`, recorded by ROS 1: the only topic of sensor_msgs/Image with depth (16UC1 or mono16 in
///   millimetres, 32FC1 in metres; rectified), K of `camera_info` in its namespace, and for the time of each
///   image the pose that tf gives its frame_id (x right, y down, z forward) in the root of the tf tree.
///   Images whose time tf does not cover are left out, with a warning; images of one and the same time are
///   all served, with the same pose. `NAME.bag.toml` beside it may state `depth_topic`, `camera_info_topic`,
///   `fixed_frame`, and those of the keys below that are no patterns, `layout` or `pose_convention`.
///
/// Keys of `dataset.toml`, all optional; file names are relative to the data set:
/// `layout` = "frames" | "tum"; `depth_pattern`, `color_pattern`, `pose_pattern` with `{number}` in the last
/// part; `intrinsics` (file) or `[camera]` with `fx`, `fy`, `cx`, `cy`; `depth_unit_m`; `invalid_depth` (list
/// of counts); `pose_convention` = "camera_to_world" | "world_to_camera"; `range_m` = [min, max];
/// `observations_per_frame`; `[T_world_dataset]` with `position_m` and `quaternion_xyzw`, or `matrix` (4 rows
/// of 4);
/// `[bounds]` with `min_m`, `max_m` (world).
struct Dataset {
  std::filesystem::path path;
  std::string layout;    ///< "frames", "tum" or "rosbag"
  PinholeCamera camera;  ///< size of the depth images; range 0.1 .. 8 m unless stated
  DepthPngFormat depth_format;
  std::shared_ptr<const DepthSource> source;  ///< null = PNG files
  std::vector<DatasetFrame> frames;           ///< ascending numbers, never empty
  Pose T_world_dataset = Pose::Identity();    ///< already applied to the poses
  std::optional<Box> bounds;                  ///< of interest, world; if stated
  int observations_per_frame = 10;            ///< one stop gives one frame
  std::vector<std::string> warnings;
};

/// True for what only openDataset() can take: any folder, any file that ends in `.bag` or begins like one of
/// ROS.
bool isDatasetPath(const std::filesystem::path& path);

/// True for a folder that openDataset() would recognise (or a folder with a `dataset.toml`), and for a bag.
bool looksLikeDataset(const std::filesystem::path& path);

/// Opens a data set: lists its frames, reads all poses and the size of every image.
/// \param toml description to use instead of a `dataset.toml` in the folder, or `NAME.bag.toml`.
/// \throws InputError naming file (and line): no known layout, no frames, a missing or broken pose, a pose
/// that is not
///         rigid, an image of another size than the first or not 16-bit, broken intrinsics or description;
///         a bag that cannot be read, several depth topics, no camera_info, no tf.
Dataset openDataset(const std::filesystem::path& path,
                    const std::optional<std::filesystem::path>& toml = std::nullopt);

/// Depth of frame `index` (position in Dataset::frames), metres. \throws InputError if the image is damaged
/// or was replaced by one of another size.
DepthImage loadDepth(const Dataset& dataset, std::size_t index);

/// Gives the data set another place in the world; stated bounds belonged to the old place and are dropped.
void placeDataset(Dataset& dataset, const Pose& T_world_dataset);

/// Defaults for a data set as input of an exploration: its camera; a workspace from the stated bounds, else
/// from the measured points (2nd to 98th percentile of each axis, over the 5 cm cells that a quarter of up to
/// 60 frames saw); a volume that covers it (5 cm margin) and the recorded cameras (15 cm) in at most 40 M
/// voxels, the truncation, the grouping distance and the segmentation's voxels growing with the voxel size; 3
/// initial frames, one frame per view, no tilt, no start bubble; no view lower than 15 cm below the lowest
/// recorded one, obstacles and paths only reported. Views are generated at the median measured depth. Values
/// that differ from the program's defaults have the origin "data set". \throws InputError if no frame holds a
/// valid pixel and no bounds are stated.
Settings settingsForDataset(const Dataset& dataset);

}  // namespace vantage
