#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "core/geometry/depth_image.h"
#include "io/error.h"

namespace vantage {

/// How numbers in a 16-bit depth image are meant.
struct DepthPngFormat {
  double unit_m = 0.001;                            ///< metres per count, > 0
  std::vector<std::uint16_t> invalid = {0, 65535};  ///< counts that mean "no measurement"
};

/// Size of an image without decoding it.
struct ImageSize {
  int width = 0, height = 0;
  bool operator==(const ImageSize&) const = default;
};

/// Depth in metres of 16-bit counts, row-major; 0 and the invalid ones become NaN.
/// \pre as many counts as pixels
DepthImage depthOfCounts(ImageSize size, std::span<const std::uint16_t> counts, const DepthPngFormat& format);

/// Reads the header of a 16-bit grey PNG.
/// \throws InputError naming the file: missing, no PNG, not 16-bit grey, or larger than 8192 x 8192.
ImageSize depthPngSize(const std::filesystem::path& path);

/// Reads a 16-bit grey PNG; invalid counts become NaN. \throws InputError as depthPngSize(), or if it is
/// damaged.
DepthImage readDepthPng(const std::filesystem::path& path, const DepthPngFormat& format = {});

/// Writes millimetres, rounded; invalid pixels and depths that do not fit (above 65.534 m) become 0.
/// \throws InputError if the file cannot be written.
void writeDepthPng(const std::filesystem::path& path, const DepthImage& depth);

/// Writes one byte a pixel as 8-bit grey, e.g. the mask of the depth filters.
/// \throws InputError if the file cannot be written, std::invalid_argument if the number of values is not
/// width x height.
void writeBytePng(const std::filesystem::path& path, int width, int height,
                  const std::vector<std::uint8_t>& values);

}  // namespace vantage
