#include "io/run_bytes.h"

#include <algorithm>

namespace vantage {
namespace {

// Elements handled at a time, so that the reads of all planes hit the cache.
constexpr std::size_t kBlock = 1024;

template <std::size_t Stride>
void splitBlock(const std::uint8_t* from, std::uint8_t* to, std::size_t count, std::size_t n,
                std::size_t stride) {
  const std::size_t s = Stride ? Stride : stride;
  for (std::size_t p = 0; p < s; ++p)
    for (std::size_t i = 0; i < n; ++i) to[p * count + i] = from[i * s + p];
}

template <std::size_t Stride>
void joinBlock(const std::uint8_t* from, std::uint8_t* to, std::size_t count, std::size_t n,
               std::size_t stride) {
  const std::size_t s = Stride ? Stride : stride;
  for (std::size_t p = 0; p < s; ++p)
    for (std::size_t i = 0; i < n; ++i) to[i * s + p] = from[p * count + i];
}

}  // namespace

void toPlanes(const std::uint8_t* from, std::uint8_t* to, std::size_t count, std::size_t stride) {
  for (std::size_t start = 0; start < count; start += kBlock) {
    const std::size_t n = std::min(kBlock, count - start);
    if (stride == 4) {
      splitBlock<4>(from + start * 4, to + start, count, n, stride);
    } else {
      splitBlock<0>(from + start * stride, to + start, count, n, stride);
    }
  }
}

void fromPlanes(const std::uint8_t* from, std::uint8_t* to, std::size_t count, std::size_t stride) {
  for (std::size_t start = 0; start < count; start += kBlock) {
    const std::size_t n = std::min(kBlock, count - start);
    if (stride == 4) {
      joinBlock<4>(from + start, to + start * 4, count, n, stride);
    } else {
      joinBlock<0>(from + start, to + start * stride, count, n, stride);
    }
  }
}

}  // namespace vantage
