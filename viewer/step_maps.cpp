#include "viewer/step_maps.h"

#include "core/exploration/planner_kind.h"

namespace vantage {

PlannerKind plannerKindOf(const RunHeader& header, const StepRecord& record) {
  return plannersFromText(record.planner.empty() ? header.planner : record.planner).front();
}

SceneFrame StepMaps::at(const StepRecord& record) {
  const RunHeader& header = reader_.header();
  if (!usesOctree(plannerKindOf(header, record)) || !header.octree) {
    advanceVolume(record.step);
    return {header, record, states_, &header.truth, nullptr, nullptr};
  }
  advanceOctree(record.step);
  return {header, record, pyramid_.finest(), &header.truth, &pyramid_, &tree_};
}

void StepMaps::advanceVolume(int step) {
  if (!volume_) {
    volume_.emplace(reader_.header().volume);
    states_ = StateGrid(reader_.header().volume);
  }
  if (step == volume_step_) return;
  states_.update(*volume_, reader_.moveVolume(*volume_, volume_step_, step));
  volume_step_ = step;
}

void StepMaps::advanceOctree(int step) {
  const OctreeHeader& octree = *reader_.header().octree;
  if (!octree_) {
    octree_.emplace(emptyOctree(reader_.header()));
    // All levels, so that any depth can be drawn, not only those that are traced.
    pyramid_ = StatePyramid(*octree_, StatePyramid::kMaxCoarseLevels);
    tree_ = RayTree(octree.planner.sensor, octree.map.voxel_size_m, octree.planner.coarse_levels);
  }
  if (step == octree_step_) return;
  pyramid_.update(*octree_, reader_.moveOctree(*octree_, octree_step_, step));
  octree_step_ = step;
}

}  // namespace vantage
