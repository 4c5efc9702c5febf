#pragma once

#include <Eigen/Geometry>

namespace vantage {

/// Rigid transform. `T_world_camera` maps camera coordinates (x right, y down, z forward) to world
/// coordinates (z up), metres.
using Pose = Eigen::Isometry3d;

/// Camera pose at `eye_world` whose optical axis (+z) is `axis_world` (any length but zero). At roll 0 the
/// image x axis is horizontal; for a vertical view it is the world x axis (D-B6). `roll_rad` turns the image
/// about the optical axis, from x toward y. \throws std::invalid_argument if the axis has no length.
Pose lookAlong(const Eigen::Vector3d& eye_world, const Eigen::Vector3d& axis_world, double roll_rad = 0.0);

/// Camera pose at `eye_world` looking at `target_world`; see lookAlong().
Pose lookAt(const Eigen::Vector3d& eye_world, const Eigen::Vector3d& target_world, double roll_rad = 0.0);

/// Pose from a position in metres and a quaternion, which is normalised first.
Pose makePose(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation);

/// Rotation of a pose as a unit quaternion with w >= 0.
Eigen::Quaterniond orientationOf(const Pose& pose);

/// True if `matrix` is a rigid transform: finite, last row (0,0,0,1), rotation part orthonormal with
/// determinant +1, each entry of R^T R within `tolerance` of the identity.
bool isRigid(const Eigen::Matrix4d& matrix, double tolerance = 1e-3);

/// Geodesic angle between the orientations of two poses, radians in [0, pi].
double angleBetween(const Pose& a, const Pose& b);
/// True if positions and orientations differ by at most as much, metres and radians.
bool isNear(const Pose& a, const Pose& b, double distance_m, double angle_rad);

}  // namespace vantage
