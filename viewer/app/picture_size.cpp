#include "viewer/app/picture_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "io/error.h"
#include "snapshots/snapshot.h"

namespace vantage::app {

std::pair<int, int> parseSize(const std::string& option, const std::string& text) {
  constexpr int kLow = SnapshotRequest::kSmallestSide, kHigh = kLargestPicture;
  int width = 0, height = 0, used = 0;
  if (std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &used) != 2 ||
      used != static_cast<int>(text.size()) || std::min(width, height) < kLow ||
      std::max(width, height) > kHigh)
    throw InputError(
        option + " " + text,
        fmt::format("not a picture size; give WIDTHxHEIGHT in pixels, each {} .. {}", kLow, kHigh));
  return {width, height};
}

}  // namespace vantage::app
