#include "core/volume/bulk_memory.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <cstdlib>
#include <fstream>
#include <limits>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>

#include "core/geometry/check.h"

namespace vantage {

std::uint64_t availableMemory() {
  std::ifstream info("/proc/meminfo");
  std::string key, unit;
  for (std::uint64_t kib = 0; info >> key >> kib; std::getline(info, unit))
    if (key == "MemAvailable:") return kib * 1024;
  return std::numeric_limits<std::uint64_t>::max();
}

void throwDoesNotFit(std::string_view what, const GridGeometry& geometry, std::size_t bytes_per_voxel) {
  const Eigen::Vector3d n = geometry.size.cast<double>();
  std::ostringstream text;
  text << what << " of " << geometry.size.x() << " x " << geometry.size.y() << " x " << geometry.size.z()
       << " voxels needs " << n.prod() * static_cast<double>(bytes_per_voxel) / (1024.0 * 1024.0)
       << " MiB and does not fit in memory; use larger voxels or smaller bounds";
  throw std::runtime_error(text.str());
}

void requireGridFits(std::string_view what, const GridGeometry& geometry, std::size_t bytes_per_voxel,
                     int smallest) {
  for (int axis = 0; axis < 3; ++axis)
    requireInRange(std::string(what) + ": size along " + "xyz"[axis] + " (voxels)", geometry.size[axis],
                   smallest, std::numeric_limits<int>::max());
  requireInRange(std::string(what) + ": voxel size (m)", geometry.voxel_size_m, 1e-6, 1e3);
  if (!geometry.origin_m.allFinite())
    throw std::invalid_argument(std::string(what) + ": origin is not finite");
  const std::uint64_t x = geometry.size.x(), y = geometry.size.y(), z = geometry.size.z();
  const bool too_many = x * y > kMaxVoxels || x * y * z > kMaxVoxels;  // neither product can overflow 64 bits
  if (too_many || x * y * z * bytes_per_voxel > availableMemory())
    throwDoesNotFit(what, geometry, bytes_per_voxel);
}

void* allocateBulk(std::size_t bytes) {
  constexpr std::size_t kLine = 64, kHugePage = std::size_t{1} << 21;
  const std::size_t alignment = bytes >= 2 * kHugePage ? kHugePage : kLine;
  void* memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (!memory) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  if (alignment == kHugePage)
    madvise(memory, bytes, MADV_HUGEPAGE);  // advice only: a refusal changes nothing
#endif
  return memory;
}

void freeBulk(void* memory) noexcept {
  std::free(memory);
}

}  // namespace vantage
