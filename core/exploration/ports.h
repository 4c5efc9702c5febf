#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/geometry/camera_model.h"
#include "core/geometry/depth_image.h"
#include "core/geometry/grid_geometry.h"
#include "core/geometry/pose.h"
#include "core/motion/path_planner.h"
#include "core/run_control.h"

namespace vantage {

/// A device that worked stopped working: which one, and what it did last. Nothing moves any more.
class DeviceLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One depth frame and where it was taken.
struct DepthFrame {
  DepthImage depth;
  Pose T_world_camera = Pose::Identity();
  int frame = -1;  ///< number in a recorded sequence, -1 for others
};

/// Where the frames of a scan were taken.
struct ScanPose {
  Pose T_world_camera = Pose::Identity();
  int frame = -1;  ///< number in a recorded sequence
};

/// A depth camera that is moved by somebody else.
class DepthCamera {
 public:
  virtual ~DepthCamera() = default;
  virtual const PinholeCamera& model() const = 0;
  /// One frame from the given pose, or the nearest that the device can serve; empty if it has none left.
  /// \param index counts the frames of this run: same run seed and index, same noise.
  /// \throws DeviceLost
  virtual std::optional<DepthFrame> capture(const Pose& T_world_camera, std::uint64_t index) = 0;
  /// Poses at which a replayed device can start (recorded order); empty for devices that can go anywhere.
  virtual std::vector<Pose> recordedPoses() const { return {}; }
  /// Those of them whose frame has not been served yet.
  virtual std::vector<ScanPose> posesLeft() const { return {}; }
};

/// Whatever carries the camera.
class Robot {
 public:
  virtual ~Robot() = default;
  virtual std::string name() const = 0;
  /// Where the robot is, as far as it knows.
  virtual RobotState state() const = 0;
  /// Camera poses of the initial scan that the robot brings along; empty for robots that start anywhere.
  virtual std::vector<Pose> startPoses() const { return {}; }
  /// Brings the camera to a pose of a scan, near where it is. A robot that can't stays where it is.
  /// \throws as execute()
  virtual void adjust(const Pose& T_world_camera, const RunControl& control) = 0;
  /// Takes over the current map; called once a step, before plan().
  virtual void observe(const StateGrid& states) = 0;
  /// A motion to a camera pose, or why there is none.
  virtual MotionPlan plan(const Pose& T_world_camera, std::uint64_t seed) = 0;
  /// Carries it out; returns the duration in seconds (simulated robots: modelled, not waited for). Where the
  /// camera is afterwards, state() tells. \throws Cancelled if a stop was requested on the way: the robot
  /// then stands within one control period; DeviceLost; std::runtime_error if it can't or must not move.
  virtual double execute(const MotionPlan& plan, const RunControl& control) = 0;
};

/// What is known about the true scene; absent on real data.
class GroundTruth {
 public:
  virtual ~GroundTruth() = default;
  /// Distance to the nearest surface of a true object (table, panel and room are none), metres, never
  /// negative.
  virtual double objectDistance(const Eigen::Vector3d& p_world) const = 0;
  /// True inside any solid, table and room included.
  virtual bool insideSolid(const Eigen::Vector3d& p_world) const = 0;
  /// Bounding boxes of the true objects.
  virtual std::vector<Box> objectBoxes() const = 0;
  /// Bounding boxes of what is no object: table, panel, room.
  virtual std::vector<Box> knownBoxes() const = 0;
  /// True inside any of that.
  virtual bool insideKnown(const Eigen::Vector3d& p_world) const = 0;
  /// Surface points of the objects, one per 4 mm^2, that some feasible view can see (evaluation.md section
  /// 2).
  virtual const std::vector<Eigen::Vector3f>& observableSurface() const = 0;
  /// True object nearest to a point (index into objectBoxes()), -1 if none within `within_m`.
  virtual int objectAt(const Eigen::Vector3d& p_world, double within_m) const = 0;
};

}  // namespace vantage
