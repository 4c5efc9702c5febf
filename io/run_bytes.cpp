#include "io/run_bytes.h"

#include <algorithm>

namespace vantage {
namespace {

// Elements handled at a time, so that the passes over all planes hit the cache.
constexpr std::size_t kBlock = 1024;

template <std::size_t Stride>
void splitBlock(const std::uint8_t* from, std::uint8_t* to, std::size_t n, std::size_t stride,
                std::size_t plane) {
  const std::size_t s = Stride ? Stride : stride;
  for (std::size_t p = 0; p < s; ++p)
    for (std::size_t i = 0; i < n; ++i) to[p * plane + i] = from[i * s + p];
}

template <std::size_t Stride>
void joinBlock(const std::uint8_t* from, std::uint8_t* to, std::size_t n, std::size_t stride,
               std::size_t plane) {
  const std::size_t s = Stride ? Stride : stride;
  for (std::size_t p = 0; p < s; ++p)
    for (std::size_t i = 0; i < n; ++i) to[i * s + p] = from[p * plane + i];
}

}  // namespace

void toPlanes(const std::uint8_t* from, std::uint8_t* to, std::size_t count, std::size_t stride,
              std::size_t plane) {
  const auto split = stride == 4 ? &splitBlock<4> : &splitBlock<0>;
  for (std::size_t start = 0; start < count; start += kBlock)
    split(from + start * stride, to + start, std::min(kBlock, count - start), stride, plane);
}

void fromPlanes(const std::uint8_t* from, std::uint8_t* to, std::size_t count, std::size_t stride,
                std::size_t plane) {
  const auto join = stride == 4 ? &joinBlock<4> : &joinBlock<0>;
  for (std::size_t start = 0; start < count; start += kBlock)
    join(from + start, to + start * stride, std::min(kBlock, count - start), stride, plane);
}

}  // namespace vantage
