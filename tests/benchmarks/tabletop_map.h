#pragma once

#include "core/motion/path_planner.h"
#include "core/volume/tsdf_volume.h"
#include "io/config_file.h"

namespace vantage::benchmarks {

/// The embedded scene `tabletop` after its initial scan.
struct TabletopMap {
  Settings settings;
  TsdfVolume volume;
  StateGrid states;
  CollisionGrid collision;
  FreeFlyerPlanner motion{{}};
  TabletopMap();
};

const TabletopMap& tabletopMap();

}  // namespace vantage::benchmarks
