#pragma once

#include "core/motion/collision_grid.h"
#include "core/volume/tsdf_volume.h"
#include "io/config_file.h"

namespace vantage::benchmarks {

/// The embedded scene `tabletop` after its initial scan.
struct TabletopMap {
  Settings settings;
  TsdfVolume volume;
  StateGrid states;
  CollisionGrid collision;
  TabletopMap();
};

const TabletopMap& tabletopMap();

}  // namespace vantage::benchmarks
