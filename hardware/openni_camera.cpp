#include "hardware/openni_camera.h"

#include <OpenNI.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <thread>

#include "hardware/frame_inbox.h"
#include "io/error.h"

namespace vantage {
namespace {

constexpr int kWait_ms = 50;  // for an image, before looking whether the thread is to end
constexpr double kMicroseconds = 1e-6;

/// What OpenNI said last, on one line.
std::string lastWords() {
  std::string words = openni::OpenNI::getExtendedError();
  std::replace(words.begin(), words.end(), '\n', ' ');
  while (!words.empty() && (words.back() == ' ' || words.back() == '\t')) words.pop_back();
  return words.empty() ? "OpenNI does not say why" : words;
}

/// Starts OpenNI once; some drivers do not survive its end, so that it runs until the program ends. \return
/// why not
std::string start() {
  static const std::string why =
      openni::OpenNI::initialize() == openni::STATUS_OK ? std::string() : lastWords();
  return why;
}

/// Metres a count of a pixel format, 0 for others than depth.
double unitOf(openni::PixelFormat format) {
  if (format == openni::PIXEL_FORMAT_DEPTH_1_MM) return 1e-3;
  return format == openni::PIXEL_FORMAT_DEPTH_100_UM ? 1e-4 : 0.0;
}

DepthImage depthOf(const openni::VideoFrameRef& frame) {
  const double unit_m = unitOf(frame.getVideoMode().getPixelFormat());
  if (unit_m == 0.0) throw std::invalid_argument("its images are no depth in millimetres or tenths of them");
  if (frame.getCroppingEnabled()) throw std::invalid_argument("its images are cropped, which is not read");
  const int width = frame.getWidth(), height = frame.getHeight(), stride = frame.getStrideInBytes();
  const int row = width * static_cast<int>(sizeof(openni::DepthPixel));
  if (width < 1 || height < 1 || stride < row || frame.getDataSize() < stride * (height - 1) + row)
    throw std::invalid_argument(
        fmt::format("{} bytes of data do not make {}x{} pixels", frame.getDataSize(), width, height));
  DepthImage depth(width, height);
  const auto* bytes = static_cast<const std::uint8_t*>(frame.getData());
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      openni::DepthPixel count;
      std::memcpy(&count, bytes + std::ptrdiff_t{v} * stride + u * sizeof count, sizeof count);
      if (count > 0) depth.at(u, v) = static_cast<float>(count * unit_m);
    }
  return depth;
}

PinholeCamera modelOf(openni::VideoStream& stream, const Eigen::Vector2d& range_m) {
  const openni::VideoMode mode = stream.getVideoMode();
  const double unit_m = unitOf(mode.getPixelFormat());
  if (unit_m == 0.0) throw std::runtime_error("it has no depth in millimetres or tenths of them");
  const double across = stream.getHorizontalFieldOfView(), down = stream.getVerticalFieldOfView();
  PinholeCamera camera;
  camera.width = mode.getResolutionX(), camera.height = mode.getResolutionY();
  camera.fx = camera.width / 2.0 / std::tan(across / 2.0),
  camera.fy = camera.height / 2.0 / std::tan(down / 2.0);
  camera.cx = (camera.width - 1) / 2.0, camera.cy = (camera.height - 1) / 2.0;
  camera.min_range_m = std::max(range_m[0], stream.getMinPixelValue() * unit_m);
  camera.max_range_m = range_m[1];
  if (const int farthest = stream.getMaxPixelValue(); farthest > 0)
    camera.max_range_m = std::min(camera.max_range_m, farthest * unit_m);
  camera.validate();
  return camera;
}

class OpenNiCamera : public LiveCamera, openni::OpenNI::DeviceDisconnectedListener {
 public:
  OpenNiCamera(const std::string& uri_, double patience_s)
      : uri(uri_), inbox("camera openni2:" + uri_, patience_s) {}
  ~OpenNiCamera() override {
    if (reader.joinable()) {
      reader.request_stop();
      reader.join();
    }
    openni::OpenNI::removeDeviceDisconnectedListener(this);
    stream.stop();
    stream.destroy();
    device.close();
  }

  const PinholeCamera& model() const override { return camera; }
  std::optional<DepthFrame> capture(const Pose& T_world_camera, std::uint64_t) override {
    if (!device.isFile()) return DepthFrame{inbox.next(), T_world_camera};
    std::optional<DepthImage> depth = play();
    if (!depth) return std::nullopt;
    return DepthFrame{std::move(*depth), T_world_camera};
  }
  std::string trouble() const override { return device.isFile() ? std::string() : inbox.trouble(); }

  void open(const Eigen::Vector2d& range_m) {
    const auto require = [](openni::Status status) {
      if (status != openni::STATUS_OK) throw std::runtime_error(lastWords());
    };
    if (const std::string why = start(); !why.empty()) throw std::runtime_error(why);
    require(device.open(uri.c_str()));
    if (!device.hasSensor(openni::SENSOR_DEPTH)) throw std::runtime_error("it has no depth");
    require(stream.create(device, openni::SENSOR_DEPTH));
    stream.setMirroringEnabled(false);  // cameras that cannot mirror refuse, and need not
    if (device.isFile()) {
      openni::PlaybackControl* playback = device.getPlaybackControl();
      playback->setRepeatEnabled(false);
      playback->setSpeed(-1.0f);  // image by image
      images_left = playback->getNumberOfFrames(stream);
    }
    camera = modelOf(stream, range_m);
    require(stream.start());
    if (device.isFile()) return;
    openni::OpenNI::addDeviceDisconnectedListener(this);
    reader = std::jthread([this](std::stop_token stop) { read(stop); });
    requireSize(inbox.next());
  }

 private:
  void requireSize(const DepthImage& depth) const {
    if (depth.width == camera.width && depth.height == camera.height) return;
    throw std::invalid_argument(fmt::format("its images are {}x{}, and it says {}x{}", depth.width,
                                            depth.height, camera.width, camera.height));
  }

  void read(std::stop_token stop) {
    while (!stop.stop_requested()) {
      openni::VideoStream* streams[] = {&stream};
      int ready = 0;
      if (openni::OpenNI::waitForAnyStream(streams, 1, &ready, kWait_ms) != openni::STATUS_OK) continue;
      openni::VideoFrameRef frame;
      if (stream.readFrame(&frame) != openni::STATUS_OK) {
        inbox.refuse(lastWords());
        std::this_thread::sleep_for(std::chrono::milliseconds(kWait_ms));
        continue;
      }
      try {
        inbox.put(depthOf(frame), static_cast<double>(frame.getTimestamp()) * kMicroseconds);
      } catch (const std::invalid_argument& error) {
        inbox.refuse(error.what());
      }
    }
  }

  void onDeviceDisconnected(const openni::DeviceInfo* info) override {
    if (uri == info->getUri()) inbox.refuse("was disconnected");
  }

  /// The next image of a recording.
  std::optional<DepthImage> play() {
    if (images_left <= 0) return std::nullopt;
    --images_left;
    openni::VideoFrameRef frame;
    if (stream.readFrame(&frame) != openni::STATUS_OK)
      throw DeviceLost("recording " + uri + ": " + lastWords());
    try {
      DepthImage depth = depthOf(frame);
      requireSize(depth);
      return depth;
    } catch (const std::invalid_argument& error) {
      throw DeviceLost("recording " + uri + ": " + error.what());
    }
  }

  const std::string uri;
  openni::Device device;
  openni::VideoStream stream;
  PinholeCamera camera;
  int images_left = 0;  ///< of a recording
  FrameInbox inbox;
  std::jthread reader;  ///< of a live camera
};

}  // namespace

std::unique_ptr<LiveCamera> openOpenNiCamera(const std::string& uri, const Eigen::Vector2d& range_m,
                                             double patience_s) {
  if (uri.ends_with(".oni") && !std::filesystem::is_regular_file(uri))
    throw InputError(uri, "is no file; give the path of a recording");
  auto camera = std::make_unique<OpenNiCamera>(uri, patience_s);
  try {
    camera->open(range_m);
  } catch (const std::exception& error) {
    throw InputError("openni2:" + uri,
                     fmt::format("{}; see 'vantage devices' for what is there", error.what()));
  }
  return camera;
}

DeviceKind openNiDevices() {
  DeviceKind kind{"openni2", true, start(), {}};
  if (!kind.note.empty()) return kind;
  openni::Array<openni::DeviceInfo> found;
  openni::OpenNI::enumerateDevices(&found);
  for (int i = 0; i < found.getSize(); ++i)
    kind.devices.push_back({fmt::format("openni2:{}", found[i].getUri()), "camera",
                            fmt::format("{} {}", found[i].getVendor(), found[i].getName())});
  if (kind.devices.empty()) kind.note = "no camera answers; is it plugged in, and is its driver installed?";
  return kind;
}

}  // namespace vantage
