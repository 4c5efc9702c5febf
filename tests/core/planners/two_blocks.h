#pragma once

#include <vector>

#include "core/planners/contour_planner.h"

namespace vantage::test {

/// A free room of 2 m with two blocks of 20 cm, A on the left and B on the right, both unknown. One contour
/// point on the front (-y) of each: point 0 on A, of segment 0 (label 1, saliency 0.2), point 1 on B, of
/// segment 1 (label 2, saliency 0.5). Poses stand about 0.8 m in front.
struct TwoBlocks {
  StateGrid states = room();
  PinholeCamera camera;
  Box workspace{Eigen::Vector3d(-1.0, -1.0, 0.0), Eigen::Vector3d(1.0, 1.0, 2.0)};
  // Off the voxels' planes: rays along those are decided by rounding.
  Eigen::Vector3d toward_front = Eigen::Vector3d(0.037, -1.0, 0.023).normalized();
  std::vector<ContourPoint> points = {{{-0.4037, -0.1013, 0.9071}, toward_front, 5},
                                      {{0.3973, -0.1013, 0.8931}, toward_front, 5}};
  std::vector<std::uint32_t> labels = {1, 2};
  Saliency saliency;
  ContourPlannerConfig config;
  std::vector<ViewPosition> positions;
  std::vector<Pose> executed;
  std::vector<Eigen::Vector3d> disappointing;

  TwoBlocks() {
    camera.width = 128;  // rolls share one grid of rays
    camera.height = 106;
    camera.fx = camera.fy = 91.25;
    camera.cx = 63.5;
    camera.cy = 52.5;
    saliency.segments = {segment(1, 0.2, {-0.4, 0.0, 0.9}), segment(2, 0.5, {0.4, 0.0, 0.9})};
    config.gain.reduction = 1;
    config.gain.gain_threshold = 100;
    block({-0.4, 0.0, 0.9}, VoxelState::Unknown);
    block({0.4, 0.0, 0.9}, VoxelState::Unknown);
    generate();
  }

  void generate() { positions = contourViewPositions(points, config.views); }

  /// Fills a cube of 20 cm.
  void block(const Eigen::Vector3d& center, VoxelState state) {
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.1);
    const Box box(center - half, center + half);
    const GridGeometry& g = states.geometry();
    for (std::size_t n = 0; n < g.count(); ++n)
      if (box.contains(g.center(g.voxel(n)))) states.set(g.voxel(n), state);
    states.rebuildFreeRadius();
  }

  ViewSearchInput input() const {
    return {.states = states,
            .camera = camera,
            .workspace = workspace,
            .points = points,
            .positions = positions,
            .point_labels = labels,
            .saliency = saliency,
            .executed = executed,
            .disappointing = disappointing};
  }

  static Segment segment(std::uint32_t label, double saliency, const Eigen::Vector3d& center) {
    Segment s;
    s.label = label;
    s.saliency = saliency;
    s.center_m = center;
    s.radius_m = 0.1;
    return s;
  }

  static StateGrid room() {
    GridGeometry geometry;
    geometry.voxel_size_m = 0.02;
    geometry.origin_m = {-0.99, -0.99, 0.01};
    geometry.size = {100, 100, 100};
    StateGrid grid(geometry);
    for (std::size_t n = 0; n < geometry.count(); ++n) grid.set(geometry.voxel(n), VoxelState::Free);
    return grid;
  }
};

inline MotionPlan verdict(Reachability r) {
  MotionPlan plan;
  plan.verdict = r;
  return plan;
}

inline MotionPlan alwaysReachable(const Pose&) {
  return verdict(Reachability::Reachable);
}

}  // namespace vantage::test
