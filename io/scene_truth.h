#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/exploration/ports.h"
#include "io/scene_file.h"

namespace vantage {

/// Which views count as feasible when it is asked what can be seen at all (evaluation.md, section 2).
struct FeasibleViews {
  /// Where the sensor may be: the mapped volume of the contour planner, above the table.
  Box region = {Eigen::Vector3d(-1.5, -1.0, 0.05), Eigen::Vector3d(1.5, 1.0, 1.12)};
  double distance_m = 0.8;      ///< from sensor to surface point, metres, > 0
  double body_radius_m = 0.08;  ///< the sensor's clearance to all solids, metres, >= 0
  int directions = 162;         ///< tried around each point, evenly spread over the sphere, 1..10000
  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// The truth about a simulated scene. All functions may be called from many threads.
class SceneTruth : public GroundTruth {
 public:
  /// Takes a copy of the scene. \throws std::invalid_argument as FeasibleViews::validate().
  explicit SceneTruth(const SceneFile& scene, const FeasibleViews& feasible = {});
  ~SceneTruth() override;

  double objectDistance(const Eigen::Vector3d& p_world) const override;
  bool insideSolid(const Eigen::Vector3d& p_world) const override;
  std::vector<Box> objectBoxes() const override;
  std::vector<Box> knownBoxes() const override;
  bool insideKnown(const Eigen::Vector3d& p_world) const override;
  int objectAt(const Eigen::Vector3d& p_world, double within_m) const override;
  /// Computed when first asked for, in parallel; the same points in the same order each time. Points inside
  /// other solids or within 1 mm of them are left out.
  const std::vector<Eigen::Vector3f>& observableSurface() const override;

  /// Names of the objects in the order of objectBoxes(): that of their first solid in the scene.
  const std::vector<std::string>& objectNames() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace vantage
