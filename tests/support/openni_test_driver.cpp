// A driver of OpenNI2 with made-up depth, so that tests need no camera. Each device behaves in a way of its
// own:
//   test://depth   streams                       test://silent   stops after some images
//   test://frozen  its stamps stand still        test://size     its images become smaller
//   test://unplugged   disconnects
// Pixel (u, v) of image n = 1, 2, .. is 500 + 7 n + u millimetres, the one at (0, 0) invalid.

#include <cstring>
#include <new>

#define XN_NEW(type, ...) (new type(__VA_ARGS__))
#define XN_DELETE(pointer) (delete pointer)
#include <Driver/OniDriverAPI.h>
#include <PS1080.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace {

using namespace oni::driver;

constexpr int kWidth = 320, kHeight = 240, kGoodImages = 20;
constexpr OniVideoMode kMode = {ONI_PIXEL_FORMAT_DEPTH_1_MM, kWidth, kHeight, 30};

template <class T>
OniStatus answer(const T& value, void* data, int* size) {
  std::memcpy(data, &value, sizeof value);
  *size = sizeof value;
  return ONI_STATUS_OK;
}

OniCropping wholeImage() {
  OniCropping cropping{};
  cropping.width = kWidth;
  cropping.height = kHeight;
  return cropping;
}

class Stream : public StreamBase {
 public:
  Stream(std::string uri, std::function<void()> unplug) : uri_(std::move(uri)), unplug_(std::move(unplug)) {}
  ~Stream() override { stop(); }

  OniStatus start() override {
    running_ = true;
    thread_ = std::thread([this] {
      for (int n = 1; running_; ++n) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        if (!sendImage(n)) return;
      }
    });
    return ONI_STATUS_OK;
  }

  void stop() override {
    running_ = false;
    if (thread_.joinable()) thread_.join();
  }

  OniBool isPropertySupported(int id) override {
    char data[256];
    int size = sizeof data;
    return getProperty(id, data, &size) == ONI_STATUS_OK;
  }

  OniStatus getProperty(int id, void* data, int* size) override {
    switch (id) {
      case ONI_STREAM_PROPERTY_VIDEO_MODE:
        return answer(kMode, data, size);
      case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
        return answer(1.0144f, data, size);
      case ONI_STREAM_PROPERTY_VERTICAL_FOV:
        return answer(0.7898f, data, size);
      case ONI_STREAM_PROPERTY_MAX_VALUE:
        return answer(int{10000}, data, size);
      case ONI_STREAM_PROPERTY_MIN_VALUE:
        return answer(int{0}, data, size);
      case ONI_STREAM_PROPERTY_STRIDE:
        return answer(int{kWidth * 2}, data, size);
      case ONI_STREAM_PROPERTY_CROPPING:
        return answer(wholeImage(), data, size);
      case ONI_STREAM_PROPERTY_MIRRORING:
        return answer(OniBool{FALSE}, data, size);
      default:
        return ONI_STATUS_NOT_SUPPORTED;
    }
  }

  OniStatus setProperty(int id, const void*, int) override {
    return id == ONI_STREAM_PROPERTY_VIDEO_MODE || id == ONI_STREAM_PROPERTY_MIRRORING
               ? ONI_STATUS_OK
               : ONI_STATUS_NOT_IMPLEMENTED;
  }

  /// A recorder writes down what it is told here.
  void notifyAllProperties() override {
    for (const int id :
         {ONI_STREAM_PROPERTY_STRIDE, ONI_STREAM_PROPERTY_CROPPING, ONI_STREAM_PROPERTY_MIRRORING,
          ONI_STREAM_PROPERTY_VIDEO_MODE, ONI_STREAM_PROPERTY_HORIZONTAL_FOV,
          ONI_STREAM_PROPERTY_VERTICAL_FOV, ONI_STREAM_PROPERTY_MAX_VALUE, ONI_STREAM_PROPERTY_MIN_VALUE}) {
      char data[256];
      int size = sizeof data;
      getProperty(id, data, &size);
      raisePropertyChanged(id, data, size);
    }
  }

 private:
  bool is(const char* uri) const { return uri_ == uri; }

  bool sendImage(int n) {
    const bool late = n > kGoodImages;
    if (late && is("test://unplugged")) unplug_();
    if (late && (is("test://unplugged") || is("test://silent"))) return false;
    OniFrame* frame = getServices().acquireFrame();
    if (!frame) return true;
    const int shrink = late && is("test://size") ? 2 : 1;
    frame->frameIndex = n;
    frame->videoMode = kMode;
    frame->width = kWidth / shrink;
    frame->height = kHeight / shrink;
    frame->videoMode.resolutionX = frame->width;
    frame->videoMode.resolutionY = frame->height;
    frame->cropOriginX = frame->cropOriginY = 0;
    frame->croppingEnabled = FALSE;
    frame->sensorType = ONI_SENSOR_DEPTH;
    frame->stride = frame->width * 2;
    frame->dataSize = frame->stride * frame->height;
    frame->timestamp = static_cast<std::uint64_t>(late && is("test://frozen") ? kGoodImages : n) * 33333;
    auto* pixels = static_cast<std::uint16_t*>(frame->data);
    for (int i = 0; i < frame->width * frame->height; ++i)
      pixels[i] = static_cast<std::uint16_t>(i == 0 ? 0 : 500 + 7 * n + i % frame->width);
    raiseNewFrame(frame);
    getServices().releaseFrame(frame);
    return true;
  }

  const std::string uri_;
  const std::function<void()> unplug_;
  std::thread thread_;
  std::atomic<bool> running_ = false;
};

class Device : public DeviceBase {
 public:
  Device(std::string uri, std::function<void()> unplug) : uri_(std::move(uri)), unplug_(std::move(unplug)) {}

  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
    *sensors = &sensor_;
    *count = 1;
    return ONI_STATUS_OK;
  }
  StreamBase* createStream(OniSensorType type) override {
    return type == ONI_SENSOR_DEPTH ? new Stream(uri_, unplug_) : nullptr;
  }
  void destroyStream(StreamBase* stream) override { delete stream; }
  OniStatus getProperty(int id, void* data, int* size) override {
    return id == ONI_DEVICE_PROPERTY_DRIVER_VERSION ? answer(OniVersion{}, data, size)
                                                    : ONI_STATUS_NOT_SUPPORTED;
  }

 private:
  const std::string uri_;
  const std::function<void()> unplug_;
  OniVideoMode mode_ = kMode;
  OniSensorInfo sensor_ = {ONI_SENSOR_DEPTH, 1, &mode_};
};

class Driver : public DriverBase {
 public:
  explicit Driver(OniDriverServices* services) : DriverBase(services) {
    for (const char* uri :
         {"test://depth", "test://silent", "test://frozen", "test://size", "test://unplugged"}) {
      OniDeviceInfo info{};
      std::strncpy(info.uri, uri, sizeof info.uri - 1);
      std::strcpy(info.vendor, "Vantage");
      std::strcpy(info.name, "made-up depth");
      devices_.push_back(info);
    }
  }

  OniStatus initialize(DeviceConnectedCallback connected, DeviceDisconnectedCallback disconnected,
                       DeviceStateChangedCallback changed, void* cookie) override {
    DriverBase::initialize(connected, disconnected, changed, cookie);
    for (const OniDeviceInfo& info : devices_) {
      deviceConnected(&info);
      deviceStateChanged(&info, 0);
    }
    return ONI_STATUS_OK;
  }
  DeviceBase* deviceOpen(const char* uri, const char*) override {
    return new Device(uri, [this, name = std::string(uri)] {
      for (const OniDeviceInfo& info : devices_)
        if (name == info.uri) deviceDisconnected(&info);
    });
  }
  void deviceClose(DeviceBase* device) override { delete device; }
  void shutdown() override {}

 private:
  std::vector<OniDeviceInfo> devices_;
};

}  // namespace

ONI_EXPORT_DRIVER(Driver)
