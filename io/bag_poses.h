#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose.h"

namespace vantage::bag {

/// A frame in its parent's at one time.
struct Transform {
  std::int64_t stamp_ns = 0;
  std::string parent, child;  ///< without the slash of tf1 in front
  Pose T_parent_child = Pose::Identity();
  bool usable = true;  ///< finite, of a unit quaternion (within 0.001), between two named frames
};

/// All transforms of a recording. Static ones hold at all times.
struct TransformLog {
  std::vector<Transform> moving, fixed;
  std::size_t unusable = 0;  ///< left out

  bool empty() const { return moving.empty() && fixed.empty(); }
  void add(std::vector<Transform> transforms, bool is_static);
  /// Names of all frames, sorted.
  std::vector<std::string> frames() const;
};

/// A frame at one time.
struct FrameTime {
  std::string frame;
  std::int64_t stamp_ns = 0;
};

/// The topmost ancestor of a frame: itself if nothing is its parent. Where parents change, the last one
/// counts. Empty if the frame is among its own ancestors.
std::string rootOf(const TransformLog& log, const std::string& frame);

/// T_fixed_frame for each, interpolated as tf2 does; nothing where the transforms do not cover the time or do
/// not connect the frames.
std::vector<std::optional<Pose>> posesAt(const TransformLog& log, const std::string& fixed_frame,
                                         const std::vector<FrameTime>& wanted);

}  // namespace vantage::bag
