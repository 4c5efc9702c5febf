#pragma once

#include "core/exploration/ports.h"
#include "io/dataset_writer.h"

namespace vantage {

/// Camera whose frames are recorded as a data set. It delivers what the data set holds, so that the recording
/// gives the same maps again.
class RecordingCamera : public DepthCamera {
 public:
  /// Refers to the camera. \throws InputError as DatasetWriter
  RecordingCamera(DepthCamera& camera, const std::filesystem::path& folder, const Settings& settings)
      : camera_(camera), writer_(folder, camera.model(), settings) {}

  const PinholeCamera& model() const override { return camera_.model(); }
  /// \throws InputError if the frame can't be written
  std::optional<DepthFrame> capture(const Pose& T_world_camera, std::uint64_t index) override {
    std::optional<DepthFrame> frame = camera_.capture(T_world_camera, index);
    if (!frame) return frame;
    DatasetWriter::Frame kept = writer_.append(frame->depth, frame->T_world_camera);
    return DepthFrame{std::move(kept.depth), kept.T_world_camera, frame->frame};
  }
  std::vector<Pose> recordedPoses() const override { return camera_.recordedPoses(); }
  std::vector<ScanPose> posesLeft() const override { return camera_.posesLeft(); }

  int framesRecorded() const { return writer_.count(); }

 private:
  DepthCamera& camera_;
  DatasetWriter writer_;
};

}  // namespace vantage
