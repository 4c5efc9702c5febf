#pragma once

#include <span>
#include <vector>

#include "core/views/sphere_views.h"
#include "io/scene_truth.h"

namespace vantage::experiments {

/// The truth about a scene whose surface counts as far as given candidate views see it (evaluation.md,
/// section 2).
class CandidateTruth : public GroundTruth {
 public:
  /// \param candidates those in free space count \param body_m edge of the robot's cube
  CandidateTruth(const SceneFile& scene, std::span<const ViewCandidate> candidates, double body_m);

  double objectDistance(const Eigen::Vector3d& p_world) const override {
    return truth_.objectDistance(p_world);
  }
  bool insideSolid(const Eigen::Vector3d& p_world) const override { return truth_.insideSolid(p_world); }
  std::vector<Box> objectBoxes() const override { return truth_.objectBoxes(); }
  int objectAt(const Eigen::Vector3d& p_world, double within_m) const override {
    return truth_.objectAt(p_world, within_m);
  }
  std::vector<Box> knownBoxes() const override { return truth_.knownBoxes(); }
  bool insideKnown(const Eigen::Vector3d& p_world) const override { return truth_.insideKnown(p_world); }
  const std::vector<Eigen::Vector3f>& observableSurface() const override { return surface_; }

  /// Distance to the nearest surface of an object or of the table, metres.
  double surfaceDistance(const Eigen::Vector3d& p_world) const;

 private:
  SceneFile scene_;
  SceneTruth truth_;
  std::vector<Eigen::Vector3f> surface_;
};

}  // namespace vantage::experiments
