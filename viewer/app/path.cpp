#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/exploration/arm_start.h"
#include "core/volume/state_pyramid.h"
#include "io/robot_file.h"
#include "io/run_robot.h"
#include "io/table_file.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/inputs.h"
#include "viewer/app/json_output.h"

namespace vantage::app {
namespace {

struct PathOptions {
  std::string map, robot, from, to, output;
};

/// Numbers with commas between them. \throws InputError
std::vector<double> numbersOf(const std::string& option, const std::string& text) {
  std::vector<double> numbers;
  const char *at = text.data(), *end = at + text.size();
  for (;;) {
    double value = 0.0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value))
      throw InputError(option + " " + text, "is no list of numbers with commas between them");
    numbers.push_back(value);
    if (next == end) return numbers;
    if (*next != ',') throw InputError(option + " " + text, "is no list of numbers with commas between them");
    at = next + 1;
  }
}

/// x, y, z, qx, qy, qz, qw. \throws InputError
Pose poseFrom(const std::string& option, const std::string& text) {
  const std::vector<double> n = numbersOf(option, text);
  if (n.size() != 7)
    throw InputError(option + " " + text,
                     fmt::format("has {} numbers; a pose has seven: x,y,z,qx,qy,qz,qw", n.size()));
  const Eigen::Quaterniond q(n[6], n[3], n[4], n[5]);
  if (!(std::abs(q.norm() - 1.0) <= 1e-3))
    throw InputError(option + " " + text, fmt::format("the quaternion has length {:g}, not 1", q.norm()));
  return makePose({n[0], n[1], n[2]}, q);
}

/// A view by its numbers, by VIEWS.csv#ID, or the one that the step chose.
Pose goalOf(const LoadedMap& map, const std::string& to) {
  if (to.empty()) {
    if (map.record && map.record->hasView()) return map.record->chosen()->T_world_camera;
    throw InputError("--to",
                     "is missing: the map is of no step that chose a view; give a pose or VIEWS.csv#ID");
  }
  const std::size_t hash = to.rfind('#');
  if (hash == std::string::npos) return poseFrom("--to", to);
  const std::string id = to.substr(hash + 1);
  for (const ViewRow& row : readViews(to.substr(0, hash)))
    if (std::to_string(row.id) == id) return row.T_world_camera;
  throw InputError("--to " + to, "no view in the table has the id '" + id + "'");
}

JointVector jointsFrom(const RobotModel& arm, const std::string& text) {
  std::vector<double> values = numbersOf("--from", text);
  if (static_cast<int>(values.size()) != arm.jointCount())
    throw InputError("--from " + text, fmt::format("has {} numbers, {} has {} joints", values.size(),
                                                   arm.name, arm.jointCount()));
  JointVector q(arm.jointCount());
  for (int i = 0; i < arm.jointCount(); ++i)
    q[i] = arm.joints[i].prismatic ? values[i] : values[i] * std::numbers::pi / 180.0;
  if (!arm.withinLimits(q))
    throw InputError("--from " + text, "lies beyond the joint limits ('vantage robots NAME' lists them)");
  return q;
}

/// Robot of the path: the one that is asked for, else the run's, else the free flyer.
std::shared_ptr<MotionPlanner> plannerFor(const LoadedMap& map, const std::string& robot) {
  if (robot.empty() && map.motion) return map.motion;
  if (robot.empty() || robot == "free") return std::make_shared<FreeFlyerPlanner>(map.settings.free_flyer);
  return std::make_shared<ArmPlanner>(loadRobot(robot), map.settings.armConfig());
}

/// Where it is told to start, else where the run's own robot stood, else the start of the arm.
RobotState startOf(const LoadedMap& map, const ArmPlanner* arm, const PathOptions& options) {
  const std::string& from = options.from;
  RobotState state = map.record ? stateAfterScan(*map.record) : RobotState();
  if (!arm) {
    if (!from.empty()) return {poseFrom("--from", from), {}};
    if (map.record) return state;
    throw InputError("--from", "is missing: the map is of no step; give a pose x,y,z,qx,qy,qz,qw");
  }
  if (!from.empty())
    state.joints = jointsFrom(arm->model(), from);
  else if (!options.robot.empty() || state.joints.size() == 0)
    state.joints = armStart(*arm, map.settings.exploration.scan).front();
  state.T_world_camera = arm->cameraPose(state.joints);
  return state;
}

void writePath(const std::string& path, const MotionPlan& plan, const ArmPlanner* arm, double speed_m_per_s) {
  if (arm) {
    std::vector<std::string> names;
    for (const ArmJoint& joint : arm->model().joints) names.push_back(joint.name);
    return writeJointPath(path, names, *plan.trajectory);
  }
  std::vector<double> times_s = {0.0};
  for (std::size_t i = 1; i < plan.waypoints.size(); ++i)
    times_s.push_back(times_s.back() +
                      (plan.waypoints[i].translation() - plan.waypoints[i - 1].translation()).norm() /
                          speed_m_per_s);
  writePosePath(path, times_s, plan.waypoints);
}

int path(const GlobalOptions& global, const PathOptions& options) {
  requireDistinctFiles({{"MAP", options.map}, {"-o", options.output}, {"--json", global.json}});
  const LoadedMap map = loadMap(global, options.map, MapNeed::Either);
  const bool of_volume = map.hasVolume();
  requireCollisionCell(map.settings,
                       of_volume ? map.volume.geometry().voxel_size_m : map.octree->geometry().voxel_size_m);
  const auto motion = plannerFor(map, options.robot);
  motion->observe(of_volume ? makeStateGrid(map.volume) : StatePyramid(*map.octree, 0).finest());
  const auto* arm = dynamic_cast<const ArmPlanner*>(motion.get());
  const Pose goal = goalOf(map, options.to);
  const RobotState start = startOf(map, arm, options);
  const MotionPlan plan = motion->plan(start, goal, pathSeed(map.settings.exploration.seed, map.step, 0));
  const bool found = plan.verdict == Reachability::Reachable;
  const double duration_s =
      plan.trajectory ? plan.trajectory->duration_s() : plan.length_m / map.settings.free_flyer.speed_m_per_s;
  nlohmann::ordered_json json = {{"verdict", tokenOf(plan.verdict)}, {"iterations", plan.iterations}};
  if (found) {
    json.update({{"straight", plan.straight}, {"length_m", plan.length_m}, {"duration_s", duration_s}});
    writePath(options.output, plan, arm, map.settings.free_flyer.speed_m_per_s);
  }
  writeJson(global.json, json);
  if (!found) throw std::runtime_error("no path: " + std::string(toString(plan.verdict)));
  if (options.output != "-" && global.json != "-")
    say(global, fmt::format("{:.2f} m of the camera in {:.1f} s, {}", plan.length_m, duration_s,
                            plan.straight ? "straight" : "around what is in the way"));
  return 0;
}

}  // namespace

void addPath(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto options = std::make_shared<PathOptions>();
  CLI::App* command = app.add_subcommand("path", "Motion of a robot to a view in a map");
  command->add_option("map", options->map, "TSDF (.vti), octree (.bt, .ot) or RUN#STEP")
      ->required()
      ->type_name("MAP");
  command
      ->add_option("--robot", options->robot,
                   "free, an arm of 'vantage robots', or a URDF file (default: the run's)")
      ->type_name("NAME");
  command
      ->add_option("--from", options->from,
                   "Joints, degrees or metres, or a camera pose of the free flyer (default: where the run's "
                   "robot is, else the arm's start)")
      ->type_name("CONFIG");
  command
      ->add_option("--to", options->to,
                   "Camera pose x,y,z,qx,qy,qz,qw or VIEWS.csv#ID (default: the view that the step chose)")
      ->type_name("VIEW");
  command->add_option("-o,--output", options->output, "Joints (rad) or camera poses over time, CSV")
      ->required()
      ->type_name("PATH.csv");
  command->footer("Example: vantage path arm.vantage#1 --robot ur5 -o path.csv");
  command->callback(
      [&global, &action, options] { action = [&global, options] { return path(global, *options); }; });
}

}  // namespace vantage::app
