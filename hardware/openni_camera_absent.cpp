#include "hardware/openni_camera.h"
#include "io/error.h"

namespace vantage {
namespace {

constexpr const char* kAbsent =
    "this program was built without OpenNI2; install libopenni2-dev and configure again";

}  // namespace

std::unique_ptr<LiveCamera> openOpenNiCamera(const std::string& uri, const Eigen::Vector2d&, double) {
  throw InputError("openni2:" + uri, kAbsent);
}

DeviceKind openNiDevices() {
  return {"openni2", false, kAbsent, {}};
}

}  // namespace vantage
