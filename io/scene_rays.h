#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>

#include "core/geometry/triangle_mesh.h"

namespace vantage {

/// Rays and distances against a triangle mesh (Embree). All queries are const and may run on many threads; a
/// ray's answer does not depend on the rays around it.
class SceneRays {
 public:
  /// Copies the mesh. An empty mesh is never hit. \throws std::runtime_error if Embree cannot be started.
  explicit SceneRays(const TriangleMesh& mesh);
  ~SceneRays();
  SceneRays(SceneRays&&) noexcept;
  SceneRays& operator=(SceneRays&&) noexcept;

  /// For every direction (any length) the parameter t > 0 of the first hit `origin + t * direction`, infinity
  /// if there is none. `t` is as long as `directions`.
  void firstHits(const Eigen::Vector3f& origin, std::span<const Eigen::Vector3f> directions,
                 std::span<float> t) const;
  /// For every target 1 if nothing lies between `from` and it, up to `margin_m` before the target, else 0.
  void visible(const Eigen::Vector3f& from, std::span<const Eigen::Vector3f> targets, float margin_m,
               std::span<std::uint8_t> result) const;
  /// True if nothing lies on the open segment.
  bool segmentFree(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const;
  /// Distance to the nearest triangle, metres; infinity for an empty mesh.
  double distance(const Eigen::Vector3d& p) const;
  /// True if most of five rays from `p` cross the mesh an odd number of times.
  bool inside(const Eigen::Vector3d& p) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace vantage
