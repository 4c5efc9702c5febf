#include "hardware/ros_image.h"

#include <fmt/format.h>
#include <sensor_msgs/image_encodings.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace vantage::ros_topics {
namespace {

constexpr std::uint32_t kMostPixels = 8192;  // along an edge, as PinholeCamera

/// Values of one type, row by row, each turned into metres.
template <class T, class ToMetres>
DepthImage decode(const sensor_msgs::Image& image, const ToMetres& metres) {
  const std::size_t row = std::size_t{image.width} * sizeof(T);
  if (image.step < row || image.data.size() < std::size_t{image.step} * (image.height - 1) + row)
    throw std::invalid_argument(fmt::format("{} bytes of data do not make {}x{} pixels of {}",
                                            image.data.size(), image.width, image.height, image.encoding));
  DepthImage depth(static_cast<int>(image.width), static_cast<int>(image.height));
  for (std::uint32_t v = 0; v < image.height; ++v)
    for (std::uint32_t u = 0; u < image.width; ++u) {
      T value;
      std::memcpy(&value, &image.data[std::size_t{v} * image.step + u * sizeof(T)], sizeof(T));
      const float z = metres(value);
      if (DepthImage::valid(z)) depth.at(static_cast<int>(u), static_cast<int>(v)) = z;
    }
  return depth;
}

}  // namespace

DepthImage depthOf(const sensor_msgs::Image& image) {
  namespace enc = sensor_msgs::image_encodings;
  if (image.width < 1 || image.height < 1 || image.width > kMostPixels || image.height > kMostPixels)
    throw std::invalid_argument(
        fmt::format("an image of {}x{} pixels; allowed: 1 .. {}", image.width, image.height, kMostPixels));
  if (image.is_bigendian) throw std::invalid_argument("its images are big-endian, which is not read");
  if (image.encoding == enc::TYPE_16UC1 || image.encoding == enc::MONO16)
    return decode<std::uint16_t>(
        image, [](std::uint16_t mm) { return mm == 65535 ? 0.0f : static_cast<float>(mm * 0.001); });
  if (image.encoding == enc::TYPE_32FC1) return decode<float>(image, [](float m) { return m; });
  throw std::invalid_argument("its images are '" + image.encoding.substr(0, 40) +
                              "', which is no depth; wanted: 16UC1, mono16 or 32FC1");
}

PinholeCamera cameraOf(const sensor_msgs::CameraInfo& info) {
  PinholeCamera camera;
  if (info.width > kMostPixels || info.height > kMostPixels)
    throw std::invalid_argument(fmt::format("camera_info is of {}x{} pixels", info.width, info.height));
  camera.width = static_cast<int>(info.width);
  camera.height = static_cast<int>(info.height);
  camera.fx = info.K[0], camera.cx = info.K[2], camera.fy = info.K[4], camera.cy = info.K[5];
  camera.validate();
  return camera;
}

}  // namespace vantage::ros_topics
