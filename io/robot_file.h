#pragma once

#include <string>
#include <vector>

#include "core/motion/robot_model.h"
#include "io/error.h"

namespace vantage {

/// Reads the model of an arm: an embedded one by name (embeddedRobots()), else a URDF file. Its meshes may be
/// PLY, OBJ or STL files: named relative to the URDF, absolutely, as file://PATH, or as package://NAME/PATH,
/// where the package is a folder NAME above the URDF. `camera_link` as for parseUrdf(). \throws InputError
/// naming file, link and what is wrong.
RobotModel loadRobot(const std::string& name_or_path, const std::string& camera_link = {});

struct EmbeddedRobot {
  std::string name;
  std::string description;  ///< one line
};
/// Sorted by name.
std::vector<EmbeddedRobot> embeddedRobots();

}  // namespace vantage
