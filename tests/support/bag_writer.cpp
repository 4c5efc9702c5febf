#include "tests/support/bag_writer.h"

// ROS 1 headers are C++17, and so is this file.
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>

namespace vantage::test {

struct BagWriter::State {
  rosbag::Bag bag;
  ros::Time now{1000, 0};

  template <typename Message>
  void write(const std::string& topic, const Message& message) {
    bag.write(topic, now, message);
    now += ros::Duration(0, 1000000);
  }
};

namespace {

ros::Time timeOf(std::int64_t stamp_ns) {
  ros::Time time;
  return time.fromNSec(static_cast<std::uint64_t>(stamp_ns));
}

}  // namespace

BagWriter::BagWriter(const std::string& path, BagPacking packing) : state_(std::make_unique<State>()) {
  state_->bag.open(path, rosbag::bagmode::Write);
  state_->bag.setChunkThreshold(16 * 1024);  // several chunks, in small bags too
  state_->bag.setCompression(packing == BagPacking::None  ? rosbag::compression::Uncompressed
                             : packing == BagPacking::Bz2 ? rosbag::compression::BZ2
                                                          : rosbag::compression::LZ4);
}

BagWriter::~BagWriter() {
  state_->bag.close();
}

void BagWriter::add(const RosImage& image) {
  sensor_msgs::Image message;
  message.header.stamp = timeOf(image.stamp_ns);
  message.header.frame_id = image.frame;
  message.width = image.width;
  message.height = image.height;
  message.step = image.step;
  message.encoding = image.encoding;
  message.is_bigendian = image.big_endian;
  message.data = image.data;
  state_->write(image.topic, message);
}

void BagWriter::add(const RosCameraInfo& info) {
  sensor_msgs::CameraInfo message;
  message.width = info.width;
  message.height = info.height;
  message.distortion_model = "plumb_bob";
  message.D = info.D;
  std::copy(info.K.begin(), info.K.end(), message.K.begin());
  state_->write(info.topic, message);
}

void BagWriter::add(const RosTransform& transform, const std::string& topic) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  auto& t = message.transforms.front();
  t.header.stamp = timeOf(transform.stamp_ns);
  t.header.frame_id = transform.parent;
  t.child_frame_id = transform.child;
  t.transform.translation.x = transform.position_m[0];
  t.transform.translation.y = transform.position_m[1];
  t.transform.translation.z = transform.position_m[2];
  t.transform.rotation.x = transform.quaternion_xyzw[0];
  t.transform.rotation.y = transform.quaternion_xyzw[1];
  t.transform.rotation.z = transform.quaternion_xyzw[2];
  t.transform.rotation.w = transform.quaternion_xyzw[3];
  state_->write(topic, message);
}

void BagWriter::addCompressedImage(const std::string& topic) {
  sensor_msgs::CompressedImage message;
  message.format = "16UC1; compressedDepth";
  state_->write(topic, message);
}

void BagWriter::addText(const std::string& topic) {
  state_->write(topic, std_msgs::String());
}

}  // namespace vantage::test
