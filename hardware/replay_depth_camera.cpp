#include "hardware/replay_depth_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vantage {

double poseDistance_m(const Pose& a, const Pose& b) {
  constexpr double kMetresPerRadian = 0.5;
  return std::hypot((a.translation() - b.translation()).norm(), kMetresPerRadian * angleBetween(a, b));
}

ReplayDepthCamera::ReplayDepthCamera(Dataset dataset)
    : dataset_(std::move(dataset)), served_(dataset_.frames.size(), false) {}

std::optional<DepthFrame> ReplayDepthCamera::capture(const Pose& T_world_camera, std::uint64_t) {
  std::optional<std::size_t> best;
  double best_distance = 0.0;
  for (std::size_t i = 0; i < served_.size(); ++i) {
    if (served_[i]) continue;
    const double distance = poseDistance_m(T_world_camera, dataset_.frames[i].T_world_camera);
    if (best && !(distance < best_distance)) continue;
    best = i;
    best_distance = distance;
  }
  if (!best) return std::nullopt;
  DepthFrame frame{loadDepth(dataset_, *best), dataset_.frames[*best].T_world_camera,
                   dataset_.frames[*best].number};
  served_[*best] = true;
  return frame;
}

std::vector<Pose> ReplayDepthCamera::recordedPoses() const {
  std::vector<Pose> poses;
  for (const DatasetFrame& frame : dataset_.frames) poses.push_back(frame.T_world_camera);
  return poses;
}

std::vector<ScanPose> ReplayDepthCamera::posesLeft() const {
  std::vector<ScanPose> poses;
  for (std::size_t i = 0; i < served_.size(); ++i)
    if (!served_[i]) poses.push_back({dataset_.frames[i].T_world_camera, dataset_.frames[i].number});
  return poses;
}

std::size_t ReplayDepthCamera::framesLeft() const {
  return static_cast<std::size_t>(std::count(served_.begin(), served_.end(), false));
}

}  // namespace vantage
