#include "viewer/run_session.h"

#include <algorithm>

#include "io/error.h"

namespace vantage {
namespace {

/// A part of something shared, which keeps the whole alive.
template <class Whole, class Part>
std::shared_ptr<const Part> partOf(const std::shared_ptr<const Whole>& whole, const Part& part) {
  return {whole, &part};
}

}  // namespace

RunSession::RunSession(std::filesystem::path path)
    : path_(std::move(path)),
      reader_(path_),
      header_(std::make_shared<const RunHeader>(reader_.header())),
      summaries_(reader_.summaries()),
      finished_(reader_.stopReason().has_value()) {}

std::shared_ptr<const StepRecord> RunSession::record(int step) const {
  const bool closing = reader_.hasClosing() && step == reader_.closingStep();
  return std::make_shared<const StepRecord>(closing ? reader_.closing(RunDetail::NoVolume)
                                                    : reader_.step(step, RunDetail::NoVolume));
}

StepData RunSession::load(int step) {
  StepData data;
  data.header = header_;
  data.record = record(step);
  if (usesOctree(plannerKindOf(*header_, *data.record)) && header_->octree) {
    const std::shared_ptr<const OctreeMap> map = octreeAt(step);
    data.octree = partOf(map, map->octree);
    data.pyramid = partOf(map, map->pyramid);
    data.states = partOf(map, map->pyramid.finest());
    data.tree = tree();
  } else {
    const std::shared_ptr<const VolumeMap> map = volumeAt(step);
    data.volume = partOf(map, map->volume);
    data.states = partOf(map, map->states);
  }
  return data;
}

void RunSession::prepare(int step) {
  const auto found = std::ranges::find(summaries_, step, &StepSummary::step);
  if (found == summaries_.end()) return;
  StepRecord record;
  record.planner = found->planner;
  if (usesOctree(plannerKindOf(*header_, record)) && header_->octree) {
    if (octrees_.hasRoom()) octreeAt(step);
  } else if (volumes_.hasRoom()) {
    volumeAt(step);
  }
}

std::shared_ptr<const RunSession::VolumeMap> RunSession::volumeAt(int step) {
  const auto make = [&] {
    return std::make_unique<VolumeMap>(VolumeMap{TsdfVolume(header_->volume), StateGrid(header_->volume)});
  };
  const auto move = [&](VolumeMap& map, int to) {
    map.states.update(map.volume, reader_.moveVolume(map.volume, map.step, to));
  };
  return volumes_.at(step, make, move);
}

std::shared_ptr<const RunSession::OctreeMap> RunSession::octreeAt(int step) {
  const auto make = [&] {
    auto map = std::make_unique<OctreeMap>(OctreeMap{emptyOctree(*header_), {}});
    // All levels, so that any depth can be drawn, not only those that are traced.
    map->pyramid = StatePyramid(map->octree, StatePyramid::kMaxCoarseLevels);
    return map;
  };
  const auto move = [&](OctreeMap& map, int to) {
    map.pyramid.update(map.octree, reader_.moveOctree(map.octree, map.step, to));
  };
  return octrees_.at(step, make, move);
}

std::shared_ptr<const RayTree> RunSession::tree() {
  const OctreeHeader& octree = *header_->octree;
  if (!tree_)
    tree_ = std::make_shared<const RayTree>(octree.planner.sensor, octree.map.voxel_size_m,
                                            octree.planner.coarse_levels);
  return tree_;
}

Exclusions RunSession::exclusionsBefore(int step) {
  Exclusions before;
  for (const StepSummary& summary : summaries_) {
    if (summary.closing || summary.step >= step) break;
    const auto known = exclusions_.find(summary.step + 1);
    if (known != exclusions_.end()) {
      before = known->second;
      continue;
    }
    before.add(*record(summary.step), header_->contour_config.gain);
    exclusions_[summary.step + 1] = before;
  }
  return before;
}

Followed RunSession::refresh() {
  Followed news;
  const RunFileState state = reader_.fileState();
  news.gone = state == RunFileState::Gone;
  news.replaced = state == RunFileState::Replaced;
  if (state != RunFileState::Same) return news;
  try {
    if (!finished_) {
      finished_ = reader_.stopReason().has_value();  // first: what is read after the end is whole
      std::vector<StepSummary> now = reader_.summaries();
      news.grown = now != summaries_;
      if (news.grown) exclusions_.clear();
      summaries_ = std::move(now);
    }
    news.finished = finished_;
  } catch (const InputError& error) {  // it may have gone in the middle of this
    const RunFileState after = reader_.fileState();
    news.gone = after == RunFileState::Gone;
    news.replaced = after == RunFileState::Replaced;
    news.problem = error.what();
  }
  return news;
}

}  // namespace vantage
