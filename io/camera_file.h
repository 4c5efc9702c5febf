#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/camera_model.h"
#include "io/error.h"

namespace vantage {

/// Reads a camera calibration as OpenCV's FileStorage (`%YAML:1.0`, `!!opencv-matrix`) or ROS `camera_info`
/// writes it: `image_width` and `image_height` (or `width`, `height`), and the 3x3 matrix as `camera_matrix`,
/// `Camera_Matrix`, `cameraMatrix`, `K` or `k`, a map with `data` or a list of nine numbers. Range limits are
/// taken from `min_range_m`, `max_range_m` if they are there, else from `defaults`. \param warnings if given,
/// receives a line if the file states lens distortion, which is not modelled. \throws InputError FILE:LINE:
/// broken YAML, a missing key, something that is no number, or values out of range.
PinholeCamera readCamera(const std::filesystem::path& path, const PinholeCamera& defaults = {},
                         std::vector<std::string>* warnings = nullptr);

/// Writes the camera in the form that ROS, OpenCV and readCamera() read. \throws InputError if it cannot be
/// written.
void writeCamera(const std::filesystem::path& path, const PinholeCamera& camera);

}  // namespace vantage
