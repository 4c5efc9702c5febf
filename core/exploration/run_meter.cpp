#include "core/exploration/run_meter.h"

namespace vantage {
namespace {

/// Of the map that the metrics are about.
const StateGrid& mainStates(const WorldModel& world) {
  return world.volume() ? *world.surfaceStates() : world.pyramid()->finest();
}

}  // namespace

RunMeter::RunMeter(const ExplorationConfig& config, const WorldModel& world, const GroundTruth* truth)
    : config_(config),
      world_(world),
      truth_(truth),
      object_box_(config.objectBox()),
      counter_(mainStates(world).geometry(), config.workspace, truth) {}

void RunMeter::measureMap(StepRecord& record) const {
  record.metrics = counter_.count(mainStates(world_));
  if (!world_.pyramid()) return;
  const StateGrid& states = world_.pyramid()->finest();
  record.box = std::make_shared<const BoxMetrics>(BoxMetrics{
      states.count(VoxelState::Unknown, object_box_), states.count(VoxelState::Occupied, object_box_)});
}

void RunMeter::measureCoverage(StepRecord& record) const {
  if (!truth_) return;
  const auto covered = [&](const std::vector<Eigen::Vector3f>& points, double distance_m) {
    record.metrics.coverage = surfaceCoverage(truth_->observableSurface(), points, distance_m);
  };
  if (record.surface) return covered(record.surface->points, kCoverageDistance_m);
  if (world_.volume())
    return covered(extractSurface(*world_.volume(), config_.contour.contours.weight_threshold).points,
                   kCoverageDistance_m);
  covered(occupiedCenters(world_.pyramid()->finest(), object_box_), config_.octree.voxel_size_m);
}

void RunMeter::markTowardObject(StepRecord& record) const {
  if (!truth_ || !record.search || !record.search->chosen) return;
  const ContourPoint& point = record.contours->points[record.search->chosen->contour_point];
  record.toward_object = truth_->objectDistance(point.position_m) <= kObjectMargin_m;
}

std::uint64_t RunMeter::unknownInRegion(const StepRecord& record) const {
  const PlannerKind kind = config_.plannerOf(record.step);
  const StateGrid& states = world_.statesOf(kind);
  if (usesOctree(kind)) return states.count(VoxelState::Unknown, object_box_);
  if (kind == PlannerKind::Standard) return states.count(VoxelState::Unknown, config_.workspace);
  return countUnknown(states, record.search->segments[record.search->chosen->search].sphere);
}

}  // namespace vantage
