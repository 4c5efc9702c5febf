#include "hardware/openni_camera.h"
#include "io/error.h"

namespace vantage {
namespace {

constexpr const char* kAbsent =
    "this program was built without OpenNI2; install libopenni2-dev and configure again";

}  // namespace

struct OpenNiCamera::State {};

OpenNiCamera::OpenNiCamera(const std::string& uri, const Eigen::Vector2d&, double) {
  throw InputError("openni2:" + uri, kAbsent);
}
OpenNiCamera::~OpenNiCamera() = default;
const PinholeCamera& OpenNiCamera::model() const {
  throw InputError("openni2", kAbsent);
}
std::optional<DepthFrame> OpenNiCamera::capture(const Pose&, std::uint64_t) {
  return std::nullopt;
}
std::string OpenNiCamera::trouble() const {
  return kAbsent;
}

DeviceKind openNiDevices() {
  return {"openni2", false, kAbsent, {}};
}

}  // namespace vantage
