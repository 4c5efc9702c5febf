#include "core/volume/cpu_path.h"

namespace vantage {

std::vector<CpuPath> availableCpuPaths() {
  std::vector<CpuPath> paths{CpuPath::Portable};
#ifdef VANTAGE_X86_KERNELS
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2")) paths.push_back(CpuPath::Avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw"))
    paths.push_back(CpuPath::Avx512);
#endif
  return paths;
}

CpuPath bestCpuPath() {
  static const CpuPath best = availableCpuPaths().back();
  return best;
}

}  // namespace vantage
