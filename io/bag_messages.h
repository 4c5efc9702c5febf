#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/bag_file.h"
#include "io/bag_poses.h"

namespace vantage::bag {

/// An image as its message states it; `data` points into the message.
struct Image {
  std::int64_t stamp_ns = 0;
  std::string frame_id;  ///< without the slash of tf1 in front
  std::uint32_t width = 0, height = 0;
  std::string encoding;
  bool big_endian = false;
  std::uint32_t step = 0;  ///< bytes a row
  std::span<const std::uint8_t> data;
};

struct CameraInfo {
  std::uint32_t width = 0, height = 0;
  std::array<double, 9> K{};  ///< row-major
  bool distorted = false;     ///< some coefficient is not 0

  bool operator==(const CameraInfo&) const = default;
};

/// What a connection carries, as far as it matters here.
enum class Content { Image, CompressedImage, CameraInfo, Transforms, Other };

/// \throws InputError naming the file for a known type of another definition than that of ROS 1.
Content contentOf(const BagFile& bag, const Connection& connection);

/// \throws InputError naming the file if the message is shorter than it states.
Image parseImage(const BagFile& bag, const Message& message);
CameraInfo parseCameraInfo(const BagFile& bag, const Message& message);
std::vector<Transform> parseTransforms(const BagFile& bag, const Message& message);

/// A name from a file in quotes for a message of one line: at most 100 characters, none that control.
std::string quoted(const std::string& name);

}  // namespace vantage::bag
