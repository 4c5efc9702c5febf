#pragma once

#include "core/exploration/ports.h"
#include "io/dataset_writer.h"

namespace vantage {

/// Camera whose frames are recorded as a data set. It delivers what the data set holds, so that the recording
/// gives the same maps again.
class RecordingCamera : public DepthCamera {
 public:
  /// Refers to the camera. The folder is made with the first frame.
  RecordingCamera(DepthCamera& camera, const std::filesystem::path& folder, const Settings& settings)
      : camera_(camera), folder_(folder), settings_(settings) {}

  const PinholeCamera& model() const override { return camera_.model(); }
  /// \throws InputError if the frame can't be written, or the folder is none of its own
  std::optional<DepthFrame> capture(const Pose& T_world_camera, std::uint64_t index) override {
    std::optional<DepthFrame> frame = camera_.capture(T_world_camera, index);
    if (!frame) return frame;
    if (!writer_) writer_.emplace(folder_, model(), settings_);
    DatasetWriter::Frame kept = writer_->append(frame->depth, frame->T_world_camera);
    return DepthFrame{std::move(kept.depth), kept.T_world_camera, frame->frame};
  }
  std::vector<Pose> recordedPoses() const override { return camera_.recordedPoses(); }
  std::vector<ScanPose> posesLeft() const override { return camera_.posesLeft(); }

 private:
  DepthCamera& camera_;
  const std::filesystem::path folder_;
  const Settings settings_;
  std::optional<DatasetWriter> writer_;
};

}  // namespace vantage
