#pragma once

#include "io/dataset_parts.h"

namespace vantage::dataset {

/// Frames, camera, depth format and source of a ROS 1 recording; poses in the fixed frame of its tf.
/// \throws InputError naming the file, or that the program was built without ROS.
Dataset openBag(const std::filesystem::path& path, const Description& description);

}  // namespace vantage::dataset
