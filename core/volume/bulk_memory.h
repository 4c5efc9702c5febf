#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/geometry/grid_geometry.h"

namespace vantage {

/// Largest grid, voxels: linear indices fit a signed 32-bit integer.
inline constexpr std::uint64_t kMaxVoxels = 2147483647;

/// Bytes that can still be allocated without swapping, as the system reports it; the largest number if it
/// does not.
std::uint64_t availableMemory();

/// Checks a grid before it is allocated with `bytes_per_voxel`.
/// \throws std::invalid_argument for a size below `smallest` or a voxel size that is not positive and finite,
///         std::runtime_error naming the size if the grid exceeds kMaxVoxels or the memory left.
void requireGridFits(std::string_view what, const GridGeometry& geometry, std::size_t bytes_per_voxel,
                     int smallest = 2);

/// \throws std::runtime_error naming size and bytes, always.
[[noreturn]] void throwDoesNotFit(std::string_view what, const GridGeometry& geometry,
                                  std::size_t bytes_per_voxel);

/// Memory for bulk voxels: aligned to cache lines, and to huge pages if it is large, because rays and fusion
/// touch it with strides that defeat small pages. \throws std::bad_alloc
void* allocateBulk(std::size_t bytes);
void freeBulk(void* memory) noexcept;

/// Allocator of BulkVector; see allocateBulk().
template <class T>
struct BulkAllocator {
  using value_type = T;
  BulkAllocator() = default;
  template <class U>
  BulkAllocator(const BulkAllocator<U>&) noexcept {}
  T* allocate(std::size_t n) { return static_cast<T*>(allocateBulk(n * sizeof(T))); }
  void deallocate(T* memory, std::size_t) noexcept { freeBulk(memory); }
  bool operator==(const BulkAllocator&) const = default;
};
template <class T>
using BulkVector = std::vector<T, BulkAllocator<T>>;

}  // namespace vantage
