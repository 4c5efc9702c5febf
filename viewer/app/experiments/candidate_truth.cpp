#include "viewer/app/experiments/candidate_truth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/scene_rays.h"

namespace vantage::experiments {
namespace {

using Eigen::Vector3f;

constexpr float kMargin_m = 3e-4f;  // what facets deviate from the surface

/// All of the surface that is not buried: a sensor this near stands in few things' way.
FeasibleViews nearby(const SceneFile& scene) {
  Box all;
  for (const Solid& solid : scene.solids) all.extend(solid.bounds());
  return {.region = all, .distance_m = 0.03, .body_radius_m = 0.0, .directions = 162};
}

/// Closer to free space than bodyFits() asks for is not needed: the room is much larger than the robot.
bool stands(const SceneTruth& truth, const Box& room, const Eigen::Vector3d& eye, double body_m) {
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(body_m / 2);
  if (!room.contains(Box(eye - half, eye + half))) return false;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    if (truth.insideSolid(eye + half.cwiseProduct(sign))) return false;
  }
  return !truth.insideSolid(eye);
}

}  // namespace

CandidateTruth::CandidateTruth(const SceneFile& scene, std::span<const ViewCandidate> candidates,
                               double body_m)
    : scene_(scene), truth_(scene, nearby(scene)) {
  const SceneRays rays(sceneMesh(scene, true));
  const Box room = nearby(scene).region;
  std::vector<Vector3f> hidden = truth_.observableSurface();
  std::vector<std::uint8_t> seen;
  for (const ViewCandidate& candidate : candidates) {
    const Eigen::Vector3d eye = candidate.T_world_camera.translation();
    if (hidden.empty() || !stands(truth_, room, eye, body_m)) continue;
    seen.assign(hidden.size(), 0);
    rays.visible(eye.cast<float>(), hidden, kMargin_m, seen);
    std::size_t left = 0;
    for (std::size_t n = 0; n < hidden.size(); ++n)
      if (seen[n])
        surface_.push_back(hidden[n]);
      else
        hidden[left++] = hidden[n];
    hidden.resize(left);
  }
}

double CandidateTruth::surfaceDistance(const Eigen::Vector3d& p_world) const {
  double distance = std::numeric_limits<double>::infinity();
  for (const Solid& solid : scene_.solids) {
    if (solid.role() == SolidRole::Room || solid.bounds().exteriorDistance(p_world) > distance) continue;
    distance = std::min(distance, std::abs(solid.signedDistance(p_world)));
  }
  return distance;
}

}  // namespace vantage::experiments
