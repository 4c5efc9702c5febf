#pragma once

#include <vector>

#include "core/geometry/pose.h"
#include "core/volume/state_grid.h"

namespace vantage::testing {

/// The reference room of acceptance check 10.4: an object of four balls on a table in a closed room, after
/// one scan. Grid of 360 x 360 x 200 voxels of 1 cm, the world's origin on the floor in the middle.
struct ReferenceRoom {
  StateGrid grid;
  Box object_box;

  /// One of the 320 views about the box that the sensor fits into.
  struct View {
    Pose T_world_camera;
    bool hidden = false;  ///< the sensor is below the table
  };
  std::vector<View> views;
};

enum class RoomBox {
  Paper,  ///< 0.8 x 0.8 x 0.52 m times the scale
  Tight,  ///< the object with a margin of 5 cm
};

/// \param scale of the object, which is 0.465 m high at 1
ReferenceRoom makeReferenceRoom(double scale, RoomBox box = RoomBox::Paper);

}  // namespace vantage::testing
