#include <exception>
#include <sstream>
#include <stdexcept>

#include "core/geometry/check.h"
#include "io/config_file.h"

namespace vantage {
namespace {

/// A box of no extent stands for the workspace; every other one has some along each axis.
void checkObjectBox(const Box& box) {
  if (box.min() == box.max()) return;
  for (int a = 0; a < 3; ++a)
    if (!(box.min()[a] < box.max()[a])) {
      std::ostringstream text;
      text << "octree.object_min_m is not below octree.object_max_m in "
           << "xyz"[a] << " (" << box.min()[a] << ", " << box.max()[a]
           << "); give both corners of the object's box";
      throw std::invalid_argument(text.str());
    }
}

/// How the structs fit together; each struct checks its own fields.
void validateTogether(const Settings& settings) {
  const GridGeometry& volume = settings.exploration.volume;
  constexpr double kMostVoxels = 2e9;  // 8 GB
  requireInRange("volume.size (product)", volume.size.cast<double>().prod(), 8.0, kMostVoxels);
  const Box& workspace = settings.exploration.workspace;
  if (workspace.isEmpty() || !(workspace.volume() > 0.0))
    throw std::invalid_argument("workspace.min_m is not below workspace.max_m in x, y and z; swap them");
  if (!workspace.intersects(volume.bounds()))
    throw std::invalid_argument("workspace lies outside the mapped volume; change workspace.* or volume.*");
  settings.exploration.fusion.validate(volume.voxel_size_m);
  checkObjectBox(settings.exploration.octree.object_box);
}

}  // namespace

void SensorNoiseConfig::validate() const {
  requireInRange("camera.noise_at_1m_m", noise_at_1m_m, 0.0, 1.0);
  requireInRange("camera.emitter_offset_m", emitter_offset_m, -1.0, 1.0);
}

Settings::Settings() = default;

ArmConfig Settings::armConfig() const {
  ArmConfig config = arm;
  config.cell_m = free_flyer.cell_m;
  config.path.check_step_m = free_flyer.check_step_m;
  config.path.rrt_iterations = free_flyer.rrt_iterations;
  config.path.safety_time_s = free_flyer.safety_time_s;
  return config;
}

void Settings::validate() const {
  try {
    camera.validate();
    sensor.validate();
    free_flyer.validate();
    armConfig().validate();
    arm_errors.validate();
    validateTogether(*this);
    exploration.validate();
  } catch (const std::invalid_argument& error) {
    std::throw_with_nested(InputError("configuration", error.what()));
  }
}

}  // namespace vantage
