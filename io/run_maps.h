#pragma once

#include <functional>
#include <map>
#include <span>
#include <vector>

#include "io/run_codec.h"

namespace vantage {

/// A step that changed a map.
struct MapStep {
  int number = 0;
  bool closing = false;
};

/// Brings one of the maps of a run, of TsdfBrick or OctreeBrick, from step to step in either direction: each
/// brick is taken from the newest step that changed it, and put in once. Remembers which bricks each product
/// holds.
template <class Brick>
class MapHistory {
 public:
  /// Gives the products of a step, within the action that it is given.
  using WithStep = std::function<void(const MapStep&, const std::function<void(const FetchProduct&)>&)>;

  /// \param steps all that the run has, ascending. \param map as it was at step `from`, 0 = empty.
  /// \return bricks that may differ. \throws DamagedBytes; the map is then in between.
  template <class Map>
  BrickSet move(Map& map, std::span<const MapStep> steps, int from, int to, const WithStep& with);

 private:
  struct Pass;
  using Chunk = std::vector<std::uint32_t>;  ///< the bricks of a product
  const std::vector<Chunk>& learn(const MapStep& step, std::size_t bricks, const WithStep& with);
  template <class Map>
  void apply(Map& map, const MapStep& step, Pass& pass, const WithStep& with);

  std::map<int, std::vector<Chunk>> chunks_;  ///< by step
};

}  // namespace vantage
