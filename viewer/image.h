#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vantage {

/// 8-bit colour picture, row-major from the top left, three bytes a pixel.
struct RgbImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;

  RgbImage() = default;
  RgbImage(int width_, int height_)
      : width(width_), height(height_), pixels(static_cast<std::size_t>(width_) * height_ * 3, 0) {}
  bool empty() const { return pixels.empty(); }
  std::array<std::uint8_t, 3> at(int x, int y) const {
    const std::size_t i = (static_cast<std::size_t>(y) * width + x) * 3;
    return {pixels[i], pixels[i + 1], pixels[i + 2]};
  }
  void set(int x, int y, const std::array<std::uint8_t, 3>& color) {
    const std::size_t i = (static_cast<std::size_t>(y) * width + x) * 3;
    for (int c = 0; c < 3; ++c) pixels[i + c] = color[c];
  }
  bool operator==(const RgbImage&) const = default;
};

/// The picture as a PNG file's bytes. \throws std::invalid_argument for an empty one.
std::string pngBytes(const RgbImage& image);

/// Writes a PNG; the folder is made if need be. A file that can't be completed is removed.
/// \throws std::runtime_error naming the file and the system's reason (no such folder, no permission, disk
/// full).
void writePng(const RgbImage& image, const std::filesystem::path& path);

}  // namespace vantage
