#pragma once

#include <vector>

namespace vantage {

/// Instruction sets that bulk loops are compiled for. Results never depend on the choice.
enum class CpuPath { Portable, Avx2, Avx512 };

/// What this processor and this build can run, slowest first; never empty.
std::vector<CpuPath> availableCpuPaths();
/// The last of availableCpuPaths().
CpuPath bestCpuPath();

}  // namespace vantage
