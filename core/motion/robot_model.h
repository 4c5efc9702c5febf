#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/grid_geometry.h"
#include "core/geometry/pose.h"
#include "core/motion/joint_vector.h"

namespace vantage {

/// A joint that moves, with the rigid part of the chain in front of it. Its frame is the joint's origin after
/// the motion; frame -1 is the base.
struct ArmJoint {
  std::string name;
  bool prismatic = false;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit, in the joint's own frame
  Pose T_parent_joint = Pose::Identity();           ///< from the frame of the joint before, at value 0
  double lower = -std::numeric_limits<double>::infinity();  ///< infinite for a continuous joint
  double upper = std::numeric_limits<double>::infinity();
  double max_velocity = 1.0;  ///< rad/s or m/s, > 0

  bool revolute() const { return !prismatic; }
  bool within(double value) const { return value >= lower && value <= upper; }
};

enum class ShapeKind { Cuboid, Cylinder, Capsule, Sphere };
std::string_view toString(ShapeKind kind);

/// A piece of a link's collision body; it moves with one frame of the arm.
struct LinkShape {
  std::string link;
  int frame = -1;  ///< index of the joint that moves it, -1 = base
  ShapeKind kind = ShapeKind::Cuboid;
  Pose T_frame_shape = Pose::Identity();  ///< origin in the middle of the shape; axis of a cylinder is z
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< full edges of a box
  double radius_m = 0.0;
  double length_m = 0.0;  ///< of a cylinder, or of the straight part of a capsule
};

/// Farthest that any part of a shape can be from the origin of its frame, metres.
double extentOf(const LinkShape& shape);

/// A description that makes no arm: which link or joint, what is wrong, what to do.
class RobotModelError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Serial arm that carries a camera: the chain from the root link to the camera, and the bodies of all links.
struct RobotModel {
  std::string name;
  std::vector<ArmJoint> joints;          ///< 1 .. kMaxArmJoints, from the base on
  std::vector<LinkShape> shapes;         ///< of every link, links beside the chain included
  Pose T_tip_camera = Pose::Identity();  ///< from the frame of the last joint to the camera
  std::string camera_link;

  int jointCount() const { return static_cast<int>(joints.size()); }
  /// All values finite and within the limits, `tolerance` rad or m beside.
  bool withinLimits(const JointVector& q, double tolerance = 1e-9) const;
};

/// Bounding box of a mesh in its own coordinates by the name in the description, metres. Throws
/// std::exception if there is none.
using MeshBounds = std::function<Box(const std::string& file)>;

/// Name of the link where a camera sits if none is given: x right, y down, z forward.
inline constexpr std::string_view kCameraLink = "camera_optical_frame";

/// Reads URDF. Fixed joints are folded in; joints beside the chain stay at 0 or their nearest limit. A
/// cylinder with spheres of its radius at both ends becomes a capsule, a mesh its bounding box (through
/// `mesh_bounds`; without one, meshes are refused). Velocities may not be missing: a planner needs them.
/// \param camera_link link of the camera; empty = kCameraLink. \throws RobotModelError for XML that is none,
/// no root or several, loops, a missing camera link, joints without limits or with limits inside out, mimic
/// and multi-axis joints in the chain, and shapes without size.
RobotModel parseUrdf(const std::string& text, const std::string& camera_link = {},
                     const MeshBounds& mesh_bounds = {});

/// Where an arm's parts are.
struct ArmFrames {
  std::vector<Pose> T_base_joint;  ///< one a joint
  Pose T_base_camera = Pose::Identity();
  /// Frame of a shape; -1 is the base.
  Pose of(int frame) const { return frame < 0 ? Pose::Identity() : T_base_joint[frame]; }
};

/// Motion of a joint in its own frame.
Pose jointMotion(const ArmJoint& joint, double value);
/// Forward kinematics. `q` has one value a joint; limits are not asked.
ArmFrames forwardKinematics(const RobotModel& model, const JointVector& q);
Pose cameraPose(const RobotModel& model, const JointVector& q);

/// Farthest that the camera or anything else that joint `first` moves can be from the origin of that joint's
/// frame, in any configuration within the limits, metres: lengths of the chain added up.
double reachBeyond(const RobotModel& model, int first);

}  // namespace vantage
