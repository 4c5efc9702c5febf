#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <string>
#include <vector>

#include "core/motion/arm_collision.h"
#include "core/motion/arm_path.h"
#include "core/motion/inverse_kinematics.h"
#include "io/robot_file.h"
#include "tests/support/random_configuration.h"

// Inverse kinematics: all solutions of camera poses that random configurations reach, from another random
// configuration. Collision: the SMART SiX beside a table in the volume of section 10, of which a room of free
// space in the middle is known. Paths: between random views over that table. One thread.

namespace vantage {
namespace {

using test::randomConfiguration;

struct Queries {
  explicit Queries(const RobotModel& arm) {
    std::mt19937_64 random(1);
    for (int n = 0; n < 1000; ++n) {
      poses.push_back(cameraPose(arm, randomConfiguration(arm, random)));
      near.push_back(randomConfiguration(arm, random));
    }
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

void fill(StateGrid& states, const Box& box, VoxelState state) {
  const GridGeometry& g = states.geometry();
  for (std::size_t n = 0; n < g.count(); ++n)
    if (box.contains(g.center(g.voxel(n)))) states.set(g.voxel(n), state);
}

/// Twelve boxes on a table; `seen` also behind them.
CollisionGrid tableCells(bool seen) {
  StateGrid states{GridGeometry{{-1.5, -1.0, -0.05}, 3.0 / 512.0, {512, 341, 200}}};
  fill(states, Box(Eigen::Vector3d(-1.3, -0.98, 0.0), Eigen::Vector3d(1.3, 0.5, 1.1)), VoxelState::Free);
  fill(states, Box(Eigen::Vector3d(-1.3, -0.66, -0.05), Eigen::Vector3d(1.3, 0.5, 0.0)),
       VoxelState::Occupied);
  for (int object = 0; object < 12; ++object) {
    const Eigen::Vector3d corner(-0.8 + 0.3 * (object % 6), object < 6 ? -0.3 : 0.2, 0.0);
    const Eigen::Vector3d size(0.12, 0.1, 0.16), behind(0.12, 0.2, 0.16);
    fill(states, Box(corner, corner + behind), seen ? VoxelState::Free : VoxelState::Unknown);
    fill(states, Box(corner, corner + size), VoxelState::Occupied);
  }
  return CollisionGrid(states, 0.04);
}

const RobotModel& smartSix() {
  static const RobotModel arm = loadRobot("smart_six");
  return arm;
}

/// On the arm's side of the table nothing else stands, and nothing hangs above it.
ArmPlace besideTheTable() {
  return {Pose(Eigen::Translation3d(0.0, -0.85, 0.0)),
          {Box(Eigen::Vector3d(-1.5, -2.0, -0.1), Eigen::Vector3d(1.5, -0.66, 2.5)),
           Box(Eigen::Vector3d(-1.5, -0.7, 1.0), Eigen::Vector3d(1.5, 1.0, 2.5))}};
}

/// Configurations that are free, or any.
void BM_StateCheck(benchmark::State& state) {
  ArmCollision collision(smartSix(), besideTheTable());
  collision.update(tableCells(false));
  std::mt19937_64 random(1);
  std::vector<JointVector> configurations;
  int drawn = 0;
  while (configurations.size() < 500 && ++drawn < 200'000) {
    JointVector q = randomConfiguration(smartSix(), random);
    if (!state.range(0) || collision.check(q).free()) configurations.push_back(std::move(q));
  }
  std::size_t n = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(collision.check(configurations[n]));
    n = (n + 1) % configurations.size();
  }
  state.counters["drawn"] = drawn;
}
BENCHMARK(BM_StateCheck)->ArgName("free")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void BM_CollisionUpdate(benchmark::State& state) {
  const CollisionGrid maps[] = {tableCells(false), tableCells(true)};
  ArmCollision collision(smartSix(), besideTheTable());
  collision.update(maps[0]);
  std::size_t written = 0;
  int n = 0;
  for (auto _ : state) written = collision.update(maps[++n % 2]);
  state.counters["cells_written"] = static_cast<double>(written);
}
BENCHMARK(BM_CollisionUpdate)->Unit(benchmark::kMillisecond);

void BM_FirstCollisionMap(benchmark::State& state) {
  const CollisionGrid map = tableCells(false);
  std::size_t written = 0;
  for (auto _ : state) {
    ArmCollision collision(smartSix(), besideTheTable());
    written = collision.update(map);
  }
  state.counters["cells_written"] = static_cast<double>(written);
}
BENCHMARK(BM_FirstCollisionMap)->Unit(benchmark::kMillisecond);

/// From one view of the table's objects to the next, all of them reachable by a solution without contact.
void BM_ArmPath(benchmark::State& state) {
  const InverseKinematics inverse(smartSix());
  ArmCollision collision(smartSix(), besideTheTable());
  collision.update(tableCells(false));
  const Pose T_base_world = besideTheTable().T_world_base.inverse();
  JointVector at(6);
  at << 1.5, -0.5, -1.9, 0.0, 0.9, 0.0;
  std::mt19937_64 random(1);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::vector<double> times_ms;
  int found = 0, straight = 0;
  std::uint64_t seed = 0;
  using Clock = std::chrono::steady_clock;
  for (auto _ : state) {
    const Eigen::Vector3d eye(-0.8 + 1.6 * unit(), -0.6 + 0.9 * unit(), 0.35 + 0.6 * unit());
    const Pose view = T_base_world * lookAt(eye, {-0.5 + unit(), 0.3 * unit(), 0.1});
    const auto begin = Clock::now();
    const ArmPath path = planArmPath(inverse, collision, at, view, {}, ++seed);
    const double ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    if (path.free_solutions == 0) continue;
    times_ms.push_back(ms);
    found += path.found();
    straight += path.straight;
    if (path.found()) at = path.configurations.back();
  }
  if (times_ms.empty()) return;
  std::sort(times_ms.begin(), times_ms.end());
  const auto count = static_cast<double>(times_ms.size());
  state.counters["queries"] = count;
  state.counters["found"] = found / count;
  state.counters["straight"] = straight / count;
  state.counters["median_ms"] = times_ms[times_ms.size() / 2];
  state.counters["p95_ms"] = times_ms[times_ms.size() * 95 / 100];
  state.counters["max_ms"] = times_ms.back();
}
BENCHMARK(BM_ArmPath)->Iterations(300)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vantage
