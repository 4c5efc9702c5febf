#include "io/run_maps.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <type_traits>

#include "io/run_fields.h"

namespace vantage {
namespace {

constexpr std::size_t kMostVoxels = std::size_t{kBrickX} * kBrickY * kBrickZ;

/// What a voxel is that no step has changed.
template <class Brick>
BrickVoxel<Brick> untouched() {
  if constexpr (std::is_same_v<Brick, OctreeBrick>) return std::nanf("");
  return {};
}

std::size_t voxelsOf(const BrickLayout& layout, std::uint32_t brick) {
  const BrickRange range = layout.range(brick);
  return static_cast<std::size_t>((range.end - range.begin).prod());
}

}  // namespace

/// Which bricks are still to be put in, one flag a brick.
template <class Brick>
struct MapHistory<Brick>::Pass {
  std::vector<std::uint8_t> wanted;

  bool wants(const Chunk& chunk) const {
    return std::ranges::any_of(chunk, [&](std::uint32_t b) { return wanted[b] != 0; });
  }
  /// Takes a brick once, whichever thread comes first.
  bool take(std::uint32_t brick) { return std::atomic_ref(wanted[brick]).exchange(0) != 0; }
};

/// The bricks of a step, by product; the map has `bricks` of them.
template <class Brick>
auto MapHistory<Brick>::learn(const MapStep& step, std::size_t bricks, const WithStep& with)
    -> const std::vector<Chunk>& {
  const auto known = chunks_.find(step.number);
  if (known != chunks_.end()) return known->second;
  std::vector<Chunk> chunks;
  with(step, [&](const FetchProduct& fetch) {
    for (const std::string& name : brickChunks<Brick>(step.number, step.closing, fetch)) {
      const BrickChunk<Brick> chunk(openProduct(fetch(bricksStage(step.closing), name), step.number));
      chunks.emplace_back(chunk.bricks().begin(), chunk.bricks().end());
      if (std::ranges::any_of(chunk.bricks(), [&](std::uint32_t b) { return b >= bricks; }))
        throw DamagedBytes("a brick outside the map");
    }
  });
  return chunks_[step.number] = std::move(chunks);
}

/// Puts those bricks of a step into the map that are still wanted.
template <class Brick>
template <class Map>
void MapHistory<Brick>::apply(Map& map, const MapStep& step, Pass& pass, const WithStep& with) {
  const BrickLayout& layout = map.bricks();
  const auto applyChunk = [&](const BrickChunk<Brick>& chunk) {
    std::vector<BrickVoxel<Brick>> voxels(kMostVoxels);
    for (std::size_t i = 0; i < chunk.bricks().size(); ++i) {
      const std::uint32_t brick = chunk.bricks()[i];
      if (brick >= layout.total()) throw DamagedBytes("a brick outside the map");
      if (chunk.voxels(i) != voxelsOf(layout, brick)) throw DamagedBytes("a brick of the wrong size");
      if (!pass.take(brick)) continue;
      chunk.read(i, voxels.data());
      map.setBrick(brick, std::span(voxels).first(chunk.voxels(i)));
    }
  };
  with(step, [&](const FetchProduct& fetch) {
    const std::vector<std::string> names = brickChunks<Brick>(step.number, step.closing, fetch);
    const auto known = chunks_.find(step.number);
    const bool learnt = known != chunks_.end() && known->second.size() == names.size();
    std::vector<StoredProduct> products;
    for (std::size_t c = 0; c < names.size(); ++c)
      if (!learnt || pass.wants(known->second[c]))
        products.push_back(fetch(bricksStage(step.closing), names[c]));
    std::vector<Chunk> chunks(products.size());
    const auto open = [&](std::size_t c) {
      const BrickChunk<Brick> chunk(openProduct(products[c], step.number));
      chunks[c].assign(chunk.bricks().begin(), chunk.bricks().end());
      applyChunk(chunk);
    };
    if constexpr (std::is_same_v<Brick, TsdfBrick>) {
      // Whoever fetches may hold a lock: its thread must not take up other work meanwhile.
      tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, products.size(), open); });
    } else {
      for (std::size_t c = 0; c < products.size(); ++c) open(c);  // a tree has one writer
    }
    if (!learnt) chunks_[step.number] = std::move(chunks);
  });
}

template <class Brick>
template <class Map>
BrickSet MapHistory<Brick>::move(Map& map, std::span<const MapStep> steps, int from, int to,
                                 const WithStep& with) {
  const BrickLayout& layout = map.bricks();
  BrickSet changed(layout.total());
  Pass pass{std::vector<std::uint8_t>(layout.total(), to >= from ? 1 : 0)};
  for (const MapStep& step : steps) {
    if (step.number <= to || step.number > from) continue;
    for (const Chunk& chunk : learn(step, layout.total(), with))
      for (const std::uint32_t brick : chunk) {
        changed.insert(brick);
        pass.wanted[brick] = 1;
      }
  }
  const int oldest = to >= from ? from : 0;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    const bool some_left = std::ranges::any_of(pass.wanted, [](std::uint8_t flag) { return flag != 0; });
    if (step->number > oldest && step->number <= to && some_left) apply(map, *step, pass, with);
  }
  for (std::uint32_t brick = 0; brick < layout.total(); ++brick) {
    if (to >= from) {
      if (!pass.wanted[brick]) changed.insert(brick);
    } else if (pass.wanted[brick]) {  // no step up to `to` has changed it
      map.setBrick(brick, std::vector(voxelsOf(layout, brick), untouched<Brick>()));
    }
  }
  return changed;
}

template class MapHistory<TsdfBrick>;
template class MapHistory<OctreeBrick>;
template BrickSet MapHistory<TsdfBrick>::move(TsdfVolume&, std::span<const MapStep>, int, int,
                                              const WithStep&);
template BrickSet MapHistory<OctreeBrick>::move(OccupancyOctree&, std::span<const MapStep>, int, int,
                                                const WithStep&);

}  // namespace vantage
