#include <benchmark/benchmark.h>

#include <algorithm>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/motion/inverse_kinematics.h"
#include "io/robot_file.h"

// Inverse kinematics: all solutions of camera poses that random configurations reach, from another random
// configuration. One thread.

namespace vantage {
namespace {

struct Queries {
  explicit Queries(const RobotModel& arm) {
    std::mt19937_64 random(1);
    for (int n = 0; n < 1000; ++n) {
      poses.push_back(cameraPose(arm, configuration(arm, random)));
      near.push_back(configuration(arm, random));
    }
  }
  static JointVector configuration(const RobotModel& arm, std::mt19937_64& random) {
    JointVector q(arm.jointCount());
    for (int i = 0; i < arm.jointCount(); ++i) {
      const double low = std::max(arm.joints[i].lower, -std::numbers::pi),
                   high = std::min(arm.joints[i].upper, std::numbers::pi);
      q[i] = low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
    }
    return q;
  }
  std::vector<Pose> poses;
  std::vector<JointVector> near;
};

void BM_InverseKinematics(benchmark::State& state, const std::string& name) {
  const RobotModel arm = loadRobot(name);
  const InverseKinematics inverse(arm);
  const Queries queries(arm);
  std::size_t n = 0, solutions = 0, solved = 0, asked = 0;
  for (auto _ : state) {
    const auto found = inverse.solve(queries.poses[n], queries.near[n]);
    solutions += found.size();
    solved += !found.empty();
    ++asked;
    n = (n + 1) % queries.poses.size();
  }
  state.counters["solutions_per_pose"] = static_cast<double>(solutions) / static_cast<double>(asked);
  state.counters["solved"] = static_cast<double>(solved) / static_cast<double>(asked);
}
BENCHMARK_CAPTURE(BM_InverseKinematics, smart_six, "smart_six")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(BM_InverseKinematics, ur5, "ur5")->Unit(benchmark::kMicrosecond);

void BM_ForwardKinematics(benchmark::State& state) {
  const RobotModel arm = loadRobot("smart_six");
  const Queries queries(arm);
  std::size_t n = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(cameraPose(arm, queries.near[n]));
    n = (n + 1) % queries.near.size();
  }
}
BENCHMARK(BM_ForwardKinematics)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace vantage
