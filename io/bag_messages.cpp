#include "io/bag_messages.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

namespace vantage::bag {
namespace {

/// The definition that a type had in all of ROS 1.
struct Definition {
  const char* type;
  const char* md5sum;
  Content content;
};

constexpr Definition kDefinitions[] = {
    {"sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743", Content::Image},
    {"sensor_msgs/CameraInfo", "c9a58c1b0b154e0e6da7578cb991d214", Content::CameraInfo},
    {"tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec", Content::Transforms},
    {"tf/tfMessage", "94810edda583a504dfda3829e70d7eec", Content::Transforms}};

struct EndsTooEarly {};

/// Reads what ROS serialises: numbers as they are in memory, texts and lists behind their length.
class Stream {
 public:
  explicit Stream(std::span<const std::uint8_t> bytes) : left_(bytes) {}

  std::span<const std::uint8_t> take(std::size_t size) {
    if (size > left_.size()) throw EndsTooEarly();
    const auto taken = left_.first(size);
    left_ = left_.subspan(size);
    return taken;
  }
  template <typename T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::string text() {
    const auto bytes = take(number<std::uint32_t>());
    return {bytes.begin(), bytes.end()};
  }

 private:
  std::span<const std::uint8_t> left_;
};

/// std_msgs/Header
struct Header {
  std::int64_t stamp_ns = 0;
  std::string frame_id;
};

std::string withoutSlash(const std::string& frame) {
  return frame.substr(std::min(frame.find_first_not_of('/'), frame.size()));
}

Header headerOf(Stream& stream) {
  stream.number<std::uint32_t>();  // a running number
  const auto seconds = stream.number<std::uint32_t>(), nanoseconds = stream.number<std::uint32_t>();
  return {seconds * std::int64_t{1'000'000'000} + nanoseconds, withoutSlash(stream.text())};
}

Transform transformOf(Stream& stream) {
  const Header header = headerOf(stream);
  Transform result{header.stamp_ns, header.frame_id, withoutSlash(stream.text())};
  Eigen::Vector3d position;
  Eigen::Quaterniond orientation;
  for (double& value : position) value = stream.number<double>();
  for (double& value : orientation.coeffs()) value = stream.number<double>();  // x, y, z, w
  result.usable = position.allFinite() && std::abs(orientation.norm() - 1.0) <= 1e-3 &&
                  !result.parent.empty() && !result.child.empty() && result.parent != result.child;
  if (result.usable) result.T_parent_child = makePose(position, orientation);
  return result;
}

/// Lists grow entry by entry: a length says nothing before its entries are there.
template <typename Read>
auto parse(const BagFile& bag, const Message& message, const char* type, const Read& read) {
  Stream stream(message.bytes);
  try {
    return read(stream);
  } catch (const EndsTooEarly&) {
    throw InputError(bag.path().string(), std::string("is damaged: a message of ") + type +
                                              " ends too early; rosbag reindex may repair it");
  }
}

}  // namespace

Content contentOf(const BagFile& bag, const Connection& connection) {
  if (connection.type == "sensor_msgs/CompressedImage") return Content::CompressedImage;
  for (const Definition& known : kDefinitions) {
    if (connection.type != known.type) continue;
    if (connection.md5sum == known.md5sum) return known.content;
    throw InputError(bag.path().string(), "the topic " + quoted(connection.topic) +
                                              " has another definition of " + known.type +
                                              " than ROS 1; rosbag fix may convert it");
  }
  return Content::Other;
}

Image parseImage(const BagFile& bag, const Message& message) {
  return parse(bag, message, "sensor_msgs/Image", [](Stream& stream) {
    const Header header = headerOf(stream);
    Image image;
    image.stamp_ns = header.stamp_ns;
    image.frame_id = header.frame_id;
    image.height = stream.number<std::uint32_t>();
    image.width = stream.number<std::uint32_t>();
    image.encoding = stream.text();
    image.big_endian = stream.number<std::uint8_t>() != 0;
    image.step = stream.number<std::uint32_t>();
    image.data = stream.take(stream.number<std::uint32_t>());
    return image;
  });
}

CameraInfo parseCameraInfo(const BagFile& bag, const Message& message) {
  return parse(bag, message, "sensor_msgs/CameraInfo", [](Stream& stream) {
    headerOf(stream);
    CameraInfo info;
    info.height = stream.number<std::uint32_t>();
    info.width = stream.number<std::uint32_t>();
    stream.text();  // the distortion's model
    const auto coefficients = stream.number<std::uint32_t>();
    for (std::uint32_t i = 0; i < coefficients; ++i)
      if (stream.number<double>() != 0.0) info.distorted = true;
    for (double& value : info.K) value = stream.number<double>();
    return info;
  });
}

std::vector<Transform> parseTransforms(const BagFile& bag, const Message& message) {
  return parse(bag, message, "tf2_msgs/TFMessage", [](Stream& stream) {
    std::vector<Transform> transforms;
    const auto count = stream.number<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) transforms.push_back(transformOf(stream));
    return transforms;
  });
}

std::string quoted(const std::string& name) {
  std::string text = name.substr(0, 100);
  std::ranges::replace_if(
      text, [](unsigned char c) { return std::iscntrl(c); }, '?');
  return "'" + text + (name.size() > 100 ? "...'" : "'");
}

}  // namespace vantage::bag
