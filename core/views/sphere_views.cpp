#include "core/views/sphere_views.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "core/geometry/check.h"
#include "core/geometry/icosphere.h"

namespace vantage {
namespace {

/// Random numbers of one view (splitmix64; Steele, Lea & Flood 2014): the same on every platform.
class ViewRandom {
 public:
  ViewRandom(std::uint64_t seed, std::uint64_t view) : state_(mix(seed) ^ mix(~view)) {}

  /// Uniform in [0, 1).
  double operator()() {
    state_ += kStep;
    return static_cast<double>(mix(state_) >> 11) * 0x1.0p-53;
  }

 private:
  static constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15ull;
  static std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
    return x ^ (x >> 31);
  }
  std::uint64_t state_;
};

/// Uniform over all rotations (Shoemake 1992).
Eigen::Quaterniond uniformRotation(ViewRandom& random) {
  const double u = random(), a = 2 * std::numbers::pi * random(), b = 2 * std::numbers::pi * random();
  const double p = std::sqrt(1 - u), q = std::sqrt(u);
  return {q * std::cos(b), p * std::sin(a), p * std::cos(a), q * std::sin(b)};
}

}  // namespace

std::vector<ViewCandidate> icosphereViews(const Eigen::Vector3d& center_world, double radius_m,
                                          int subdivisions) {
  requireInRange("radius of the view sphere", radius_m, std::numeric_limits<double>::min(), 1e6);
  std::vector<ViewCandidate> views;
  for (const Eigen::Vector3d& direction : faceDirections(makeIcosphere(subdivisions)))
    views.push_back({static_cast<std::uint32_t>(views.size()),
                     lookAlong(center_world + radius_m * direction, -direction)});
  return views;
}

std::vector<ViewCandidate> workspaceViews(const Box& positions, int count, std::uint64_t seed) {
  requireInRange("number of workspace views", count, 0, 10'000'000);
  if (positions.isEmpty() || !positions.sizes().allFinite())
    throw std::invalid_argument(
        "workspace views: the box of positions is empty or not finite; give a box "
        "whose lower corner lies below its upper one");
  std::vector<ViewCandidate> views(static_cast<std::size_t>(count));
  for (std::size_t n = 0; n < views.size(); ++n) {
    ViewRandom random(seed, n);
    Eigen::Vector3d at;
    for (double& share : at) share = random();
    views[n].id = static_cast<std::uint32_t>(n);
    views[n].T_world_camera =
        makePose(positions.min() + at.cwiseProduct(positions.sizes()), uniformRotation(random));
  }
  return views;
}

}  // namespace vantage
