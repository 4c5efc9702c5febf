#include "io/bag_dataset.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "io/bag_depth.h"
#include "io/bag_poses.h"
#include "io/bag_topics.h"
#include "io/suggest.h"

namespace vantage::dataset {
namespace {

namespace fs = std::filesystem;
using namespace bag;

/// What one pass over the recording brings.
struct Recording {
  std::vector<FrameTime> images;  ///< by frame number
  std::optional<CameraInfo> camera_info;
  bool camera_info_changes = false;
  TransformLog transforms;
};

/// A message to be read, and for what.
struct Task {
  MessagePlace place;
  Content content = Content::Other;
  std::size_t number = 0;  ///< of an image
  bool is_static = false;  ///< of transforms
};

/// In file order, so that each chunk is unpacked once.
std::vector<Task> listTasks(const BagFile& bag, const DepthTopic& depth, const std::string& camera_info) {
  std::vector<Task> tasks;
  for (std::size_t i = 0; i < depth.places().size(); ++i)
    tasks.push_back({depth.places()[i], Content::Image, i, false});
  for (const Connection& connection : bag.connections()) {
    const Content content = contentOf(bag, connection);
    const bool wanted =
        content == Content::Transforms || (content == Content::CameraInfo && connection.topic == camera_info);
    if (!wanted) continue;
    const bool is_static = connection.topic.ends_with("tf_static");
    for (const MessagePlace& place : connection.messages) tasks.push_back({place, content, 0, is_static});
  }
  std::ranges::stable_sort(tasks, {}, [](const Task& task) {
    // the first image before the others, which must be like it
    return std::tuple(task.content != Content::Image || task.number > 0, task.place.chunk, task.place.offset);
  });
  return tasks;
}

Recording readRecording(const BagFile& bag, DepthTopic& depth, const std::string& camera_info) {
  Recording result;
  result.images.resize(depth.places().size());
  for (const Task& task : listTasks(bag, depth, camera_info)) {
    const Message message = bag.read(task.place);
    if (task.content == Content::Image) {
      const Image image = depth.open(task.number, message);
      result.images[task.number] = {image.frame_id, image.stamp_ns};
    } else if (task.content == Content::CameraInfo) {
      const CameraInfo info = parseCameraInfo(bag, message);
      if (!result.camera_info) result.camera_info = info;
      if (info != *result.camera_info) result.camera_info_changes = true;
    } else {
      result.transforms.add(parseTransforms(bag, message), task.is_static);
    }
  }
  return result;
}

PinholeCamera cameraOfInfo(const Dataset& result, const std::string& topic, const Recording& recording,
                           std::vector<std::string>& warnings) {
  const CameraInfo& info = recording.camera_info.value();
  const auto& K = info.K;
  const bool usable = std::ranges::all_of(K, [](double x) { return std::isfinite(x); }) && K[0] > 0.0 &&
                      K[4] > 0.0 && K[1] == 0.0 && K[3] == 0.0 && K[6] == 0.0 && K[7] == 0.0 && K[8] == 1.0;
  if (!usable)
    throw InputError(result.path.string(), "K in " + quoted(topic) +
                                               " is no camera matrix (rows fx 0 cx, 0 fy cy, 0 0 1); is the "
                                               "camera not calibrated? State [camera] in " +
                                               result.path.filename().string() + ".toml beside it");
  const bool states_size = info.width != 0 || info.height != 0;
  if (states_size && (info.width != static_cast<std::uint32_t>(result.camera.width) ||
                      info.height != static_cast<std::uint32_t>(result.camera.height)))
    throw InputError(result.path.string(), quoted(topic) + " is of images of " + std::to_string(info.width) +
                                               "x" + std::to_string(info.height) + ", those recorded are " +
                                               std::to_string(result.camera.width) + "x" +
                                               std::to_string(result.camera.height));
  if (info.distorted)
    warnings.push_back(result.path.string() + ": " + quoted(topic) +
                       " states distortion; depth images are taken as rectified");
  if (recording.camera_info_changes)
    warnings.push_back(result.path.string() + ": " + quoted(topic) + " changes; its first message is taken");
  PinholeCamera camera = result.camera;
  camera.fx = K[0], camera.fy = K[4], camera.cx = K[2], camera.cy = K[5];
  return camera;
}

PinholeCamera cameraOf(const Dataset& result, const Description& description, const std::string& topic,
                       const Recording& recording, std::vector<std::string>& warnings) {
  if (!description.camera && !description.intrinsics_file)
    return cameraOfInfo(result, topic, recording, warnings);
  PinholeCamera camera = description.camera
                             ? *description.camera
                             : readIntrinsics(result.path.parent_path() / *description.intrinsics_file);
  camera.width = result.camera.width, camera.height = result.camera.height;
  return camera;
}

/// \throws InputError if tf cannot connect the camera's frame with the fixed one at any time
std::string fixedFrame(const fs::path& path, const Description& description, const Recording& recording) {
  const TransformLog& log = recording.transforms;
  const std::string& camera = recording.images.front().frame;
  if (log.empty())
    throw InputError(path.string(), "holds no tf, and without it no poses; record /tf and /tf_static too");
  if (camera.empty()) throw InputError(path.string(), "the depth images state no frame_id");
  const std::vector<std::string> frames = log.frames();
  const auto require = [&](const std::string& frame, const std::string& what) {
    if (!std::ranges::binary_search(frames, frame))
      throw InputError(path.string(),
                       "its tf has no frame " + quoted(frame) + ", " + what + suggestion(frame, frames));
  };
  require(camera, "in which the depth images are");
  const std::string root = rootOf(log, camera);
  if (!description.fixed_frame) {
    if (root.empty())
      throw InputError(path.string(), "its tf goes round in a circle above " + quoted(camera));
    return root;
  }
  require(*description.fixed_frame, "which fixed_frame names");
  if (rootOf(log, *description.fixed_frame) != root)
    throw InputError(path.string(), "its tf does not connect " + quoted(camera) + " with the fixed frame " +
                                        quoted(*description.fixed_frame));
  return *description.fixed_frame;
}

/// Images with a pose.
std::vector<DatasetFrame> framesOf(const fs::path& path, const Recording& recording,
                                   const std::string& fixed_frame, std::vector<std::string>& warnings) {
  const auto poses = posesAt(recording.transforms, fixed_frame, recording.images);
  std::vector<DatasetFrame> frames;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (poses[i]) frames.push_back({static_cast<int>(i), {}, {}, *poses[i]});
  if (frames.empty())
    throw InputError(path.string(), "tf does not cover the time of any depth image between " +
                                        quoted(recording.images.front().frame) + " and " +
                                        quoted(fixed_frame));
  if (const std::size_t without = poses.size() - frames.size(); without > 0)
    warnings.push_back(path.string() + ": tf does not cover the time of " + std::to_string(without) + " of " +
                       std::to_string(poses.size()) + " images; they are left out");
  return frames;
}

void warnOfTimes(const fs::path& path, const Recording& recording, std::vector<std::string>& warnings) {
  std::vector<std::int64_t> stamps;
  for (const FrameTime& image : recording.images) stamps.push_back(image.stamp_ns);
  std::ranges::sort(stamps);
  const auto repeated = std::ranges::unique(stamps).size();
  if (repeated > 0)
    warnings.push_back(path.string() + ": " + std::to_string(repeated) +
                       " images have the time of another one, and so its pose");
  if (recording.transforms.unusable > 0)
    warnings.push_back(path.string() + ": " + std::to_string(recording.transforms.unusable) +
                       " transforms of tf are not usable and are left out");
}

}  // namespace

Dataset openBag(const fs::path& path, const Description& description) {
  const auto file = std::make_shared<const BagFile>(path);
  const Topics topics = chooseTopics(*file, description);
  const auto depth = std::make_shared<DepthTopic>(file, topics.depth);
  const Recording recording = readRecording(*file, *depth, topics.camera_info);

  Dataset result;
  result.path = path;
  result.layout = "rosbag";
  result.camera.width = depth->size().width;
  result.camera.height = depth->size().height;
  result.camera = cameraOf(result, description, topics.camera_info, recording, result.warnings);
  const std::string fixed_frame = fixedFrame(path, description, recording);
  result.frames = framesOf(path, recording, fixed_frame, result.warnings);
  warnOfTimes(path, recording, result.warnings);
  if (isMetres(depth->encoding())) result.depth_format = {1.0, {}};
  result.source = depth;
  return result;
}

}  // namespace vantage::dataset
