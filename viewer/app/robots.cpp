#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/motion/inverse_kinematics.h"
#include "io/robot_file.h"
#include "viewer/app/command.h"
#include "viewer/app/json_output.h"

namespace vantage::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180.0 / std::numbers::pi;

struct RobotsOptions {
  std::string robot;
  std::string camera_link;
};

/// The free flyer and the embedded arms.
std::vector<EmbeddedRobot> knownRobots() {
  std::vector<EmbeddedRobot> robots = {
      {"free", "Free-flying camera: goes where its ball fits, without an arm"}};
  for (EmbeddedRobot& robot : embeddedRobots()) robots.push_back(std::move(robot));
  return robots;
}

int listRobots(const GlobalOptions& global) {
  const std::vector<EmbeddedRobot> robots = knownRobots();
  std::size_t width = 0;
  for (const EmbeddedRobot& robot : robots) width = std::max(width, robot.name.size());
  Json list = Json::array();
  for (const EmbeddedRobot& robot : robots) {
    if (global.json != "-") fmt::print("{:<{}} {}\n", robot.name, width + 1, robot.description);
    list.push_back({{"name", robot.name}, {"description", robot.description}});
  }
  writeJson(global.json, list);
  return 0;
}

/// Degrees, or metres of a sliding joint.
std::string limitText(const ArmJoint& joint, double value) {
  if (std::isinf(value)) return "none";
  return joint.prismatic ? fmt::format("{:.3f} m", value) : fmt::format("{:.1f} deg", value * kDegrees);
}

std::string speedText(const ArmJoint& joint) {
  return joint.prismatic ? fmt::format("{:.3f} m/s", joint.max_velocity)
                         : fmt::format("{:.1f} deg/s", joint.max_velocity * kDegrees);
}

Json limitJson(double value) {
  return std::isinf(value) ? Json() : Json(value);
}

Json jointJson(const ArmJoint& joint) {
  return {{"name", joint.name},
          {"kind", joint.prismatic ? "prismatic" : "revolute"},
          {"lower", limitJson(joint.lower)},
          {"upper", limitJson(joint.upper)},
          {"max_velocity", joint.max_velocity}};
}

void printRobot(const RobotModel& robot, bool closed_form) {
  fmt::print("{}: {} joints, {} bodies, camera at {}; inverse kinematics {}\n", robot.name,
             robot.jointCount(), robot.shapes.size(), robot.camera_link,
             closed_form ? "in closed form (spherical wrist)" : "by search from many starts");
  std::size_t width = 5;
  for (const ArmJoint& joint : robot.joints) width = std::max(width, joint.name.size());
  fmt::print("{:<{}} {:>12} {:>12} {:>13}\n", "joint", width, "from", "to", "speed");
  for (const ArmJoint& joint : robot.joints)
    fmt::print("{:<{}} {:>12} {:>12} {:>13}\n", joint.name, width, limitText(joint, joint.lower),
               limitText(joint, joint.upper), speedText(joint));
}

/// The free flyer has no joints to show.
int showFreeFlyer(const GlobalOptions& global) {
  const EmbeddedRobot robot = knownRobots().front();
  if (global.json != "-") fmt::print("{}: {}\n", robot.name, robot.description);
  writeJson(global.json,
            {{"name", robot.name}, {"description", robot.description}, {"joints", Json::array()}});
  return 0;
}

int showRobot(const GlobalOptions& global, const RobotsOptions& options) {
  if (options.robot == knownRobots().front().name) return showFreeFlyer(global);
  const RobotModel robot = loadRobot(options.robot, options.camera_link);
  const bool closed_form = InverseKinematics(robot).analytic();
  if (global.json != "-") printRobot(robot, closed_form);
  Json joints = Json::array();
  for (const ArmJoint& joint : robot.joints) joints.push_back(jointJson(joint));
  writeJson(global.json, {{"name", robot.name},
                          {"camera_link", robot.camera_link},
                          {"closed_form", closed_form},
                          {"bodies", robot.shapes.size()},
                          {"joints", joints}});
  return 0;
}

}  // namespace

void addRobots(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto options = std::make_shared<RobotsOptions>();
  CLI::App* command = app.add_subcommand("robots", "List the embedded arms, or show the joints of one");
  command->add_option("robot", options->robot, "Embedded arm, or a URDF file")->type_name("NAME|FILE.urdf");
  command
      ->add_option("--camera-link", options->camera_link,
                   fmt::format("Link of the camera, z forward, y down (default: {})", kCameraLink))
      ->type_name("LINK")
      ->needs(command->get_option("robot"));
  command->footer("Example: vantage robots smart_six");
  command->callback([&global, &action, options] {
    action = [&global, options] {
      return options->robot.empty() ? listRobots(global) : showRobot(global, *options);
    };
  });
}

}  // namespace vantage::app
