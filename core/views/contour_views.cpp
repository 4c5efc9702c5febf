#include "core/views/contour_views.h"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/geometry/check.h"

namespace vantage {

namespace {

/// The normal and four directions tilted from it; azimuth 0 lies along the image x axis of roll 0 (D-B6).
std::array<Eigen::Vector3d, 5> directionsAround(const Eigen::Vector3d& normal, double tilt_rad) {
  const Eigen::Matrix3d image = lookAlong(Eigen::Vector3d::Zero(), -normal).linear();
  const Eigen::Vector3d x = image.col(0), y = image.col(1);
  const Eigen::Vector3d along = std::cos(tilt_rad) * normal;
  const double aside = std::sin(tilt_rad);
  return {normal, along + aside * x, along + aside * y, along - aside * x, along - aside * y};
}

/// Rotation about the optical axis. Rolls a quarter (or else half) turn apart differ by exact swaps and signs
/// of the axes, so that poses which share a grid of rays (D-B11) share it to the last bit.
Eigen::Matrix3d rollMatrix(int roll, int rolls) {
  const int turns = rolls % 4 == 0 ? 4 : rolls % 2 == 0 ? 2 : 1;
  const int rolls_per_turn = rolls / turns;
  const double angle_rad = 2.0 * std::numbers::pi * (roll % rolls_per_turn) / rolls;
  double c = std::cos(angle_rad), s = std::sin(angle_rad);
  for (int quarter = 0; quarter < roll / rolls_per_turn * (4 / turns); ++quarter) {
    const double next_s = c;
    c = -s;
    s = next_s;
  }
  Eigen::Matrix3d R;
  R << c, -s, 0, s, c, 0, 0, 0, 1;
  return R;
}

}  // namespace

void ContourViewConfig::validate() const {
  if (distances_m.empty())
    throw std::invalid_argument("views.distances_m is empty; give at least one distance");
  for (const double distance : distances_m) requireInRange("views.distances_m", distance, 1e-3, 100.0);
  requireInRange("views.tilt_rad", tilt_rad, 0.0, std::numbers::pi / 2);
  requireInRange("views.rolls", rolls, 1, 64);
}

std::vector<ViewPosition> contourViewPositions(const std::vector<ContourPoint>& points,
                                               const ContourViewConfig& config) {
  config.validate();
  std::vector<ViewPosition> positions;
  positions.reserve(points.size() * config.distances_m.size() * 5);
  for (std::size_t group = 0; group < points.size(); ++group) {
    const Eigen::Vector3d& p = points[group].position_m;
    const auto directions = directionsAround(points[group].normal.normalized(), config.tilt_rad);
    for (const double distance : config.distances_m) {
      for (const Eigen::Vector3d& direction : directions) {
        ViewPosition position;
        position.first_id = static_cast<std::uint32_t>(positions.size()) * config.rolls;
        position.group = static_cast<std::uint32_t>(group);
        position.T_world_camera = lookAlong(p + distance * direction, -direction);
        positions.push_back(position);
      }
    }
  }
  return positions;
}

Pose rolledPose(const ViewPosition& position, int roll, const ContourViewConfig& config) {
  Pose pose = position.T_world_camera;
  pose.linear() = position.T_world_camera.linear() * rollMatrix(roll, config.rolls);
  return pose;
}

std::vector<CandidateView> contourViews(const std::vector<ContourPoint>& points,
                                        const ContourViewConfig& config) {
  const std::vector<ViewPosition> positions = contourViewPositions(points, config);
  std::vector<CandidateView> views;
  views.reserve(positions.size() * config.rolls);
  for (const ViewPosition& position : positions) {
    for (int roll = 0; roll < config.rolls; ++roll) {
      views.push_back({position.first_id + roll, position.group, rolledPose(position, roll, config)});
    }
  }
  return views;
}

}  // namespace vantage
