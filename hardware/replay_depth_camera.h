#pragma once

#include <optional>
#include <vector>

#include "core/exploration/ports.h"
#include "io/dataset.h"

namespace vantage {

/// How far apart two camera poses are for the choice of a recorded frame: sqrt(|dx|^2 + (0.5 m/rad *
/// angle)^2), metres. Half a metre a radian: what turning by that angle moves at a typical working distance
/// of half a metre.
double poseDistance_m(const Pose& a, const Pose& b);

/// Depth camera that serves a recorded sequence: each request gets the nearest frame not yet served
/// (poseDistance_m(), ties to the lower frame number) with the pose at which it was taken.
class ReplayDepthCamera : public DepthCamera {
 public:
  explicit ReplayDepthCamera(Dataset dataset);

  const PinholeCamera& model() const override { return dataset_.camera; }
  /// Empty when every frame has been served. \throws InputError if the image is damaged.
  std::optional<DepthFrame> capture(const Pose& T_world_camera, std::uint64_t index) override;
  std::vector<Pose> recordedPoses() const override;
  std::vector<ScanPose> posesLeft() const override;

  const Dataset& dataset() const { return dataset_; }
  std::size_t framesLeft() const;

 private:
  Dataset dataset_;
  std::vector<bool> served_;  ///< per frame
};

}  // namespace vantage
