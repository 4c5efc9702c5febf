#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/motion/collision_grid.h"
#include "core/motion/robot_model.h"

namespace vantage {

/// Where an arm stands and what is known about the space around it.
struct ArmPlace {
  Pose T_world_base = Pose::Identity();
  /// Boxes that the operator vouches for, world: nothing but the arm is in them. An arm mostly stands beyond
  /// the mapped volume, where nothing is ever seen; without such a box it could not move at all.
  std::vector<Box> clear_boxes;
};

/// What a configuration touches.
struct ArmContact {
  enum class With { Nothing, Obstacle, Itself };
  With with = With::Nothing;
  std::string link;   ///< empty with Nothing
  std::string other;  ///< the other link, with Itself
  bool free() const { return with == With::Nothing; }
};

/// An arm's bodies against each other and against the collision cells (FCL). Occupied and unknown cells are
/// obstacles, and so is everything beyond the mapped volume; cells whose centre lies in a vouched box are
/// free, whatever the map says (it may have seen the arm). Bodies of the base stand where they stand and are
/// not asked about cells. Bodies of neighbouring joints never collide with each other: they are built to
/// touch.
class ArmCollision {
 public:
  ArmCollision(const RobotModel& model, const ArmPlace& place);
  ~ArmCollision();
  ArmCollision(ArmCollision&&) noexcept;
  ArmCollision& operator=(ArmCollision&&) noexcept;

  /// Takes over the cells; only those that differ from the last call are written. Until the first call
  /// everything is an obstacle.
  /// \return cells written. \throws std::invalid_argument for cells of another geometry than the first ones,
  /// or for an arm that reaches more than 512 cells.
  std::size_t update(const CollisionGrid& grid);

  /// First contact found: obstacles, from the base on, then the arm itself. Not for several threads at once.
  ArmContact check(const JointVector& q) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace vantage
