#pragma once

#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "core/geometry/depth_image.h"
#include "core/geometry/pose.h"
#include "tests/support/bag_writer.h"

namespace vantage::test {

constexpr std::int64_t kSequenceStart_ns = 1'700'000'000'000'000'000;
constexpr int kSequenceWidth = 64, kSequenceHeight = 48;

/// A made-up recording: a camera on a moving base looks at a wall 1 m ahead with a bump in it.
struct BagSequence {
  int frames = 6;
  std::string encoding = "16UC1";
  std::string topic = "/camera/depth/image_raw";
  double tf_step_s = 0.1;  ///< between transforms of the base; images are 0.1 s apart
  bool with_info = true, with_tf = true, with_static_tf = true;
  std::array<double, 9> K{60, 0, 31.5, 0, 61, 23.5, 0, 0, 1};
  std::vector<double> D = {0, 0, 0, 0, 0};
  std::function<void(int, RosImage&)> change;  ///< of each image before it is written
  std::function<void(BagWriter&)> more;

  static std::int64_t stampOf(double seconds) {
    return kSequenceStart_ns + static_cast<std::int64_t>(std::llround(seconds * 1e9));
  }
  static Pose poseOfBase(double seconds) {
    return makePose({0.3 * seconds, -0.1 * seconds, 0.2},
                    Eigen::Quaterniond(Eigen::AngleAxisd(0.4 * seconds, Eigen::Vector3d(0.6, 0, 0.8))));
  }
  /// Optical frame: x right, y down, z forward, on a base whose x is forward.
  static Pose poseOfCamera() { return makePose({0.05, 0.01, 0.1}, Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5)); }
  static Pose poseOfFrame(int n) { return poseOfBase(0.1 * n) * poseOfCamera(); }

  /// In whole millimetres; the first pixel holds nothing.
  static std::uint16_t countOf(int n, int u, int v) {
    if (u == 0 && v == 0) return 0;
    const double r2 = std::pow(u - 32.0 - n, 2) + std::pow(v - 24.0, 2);
    return static_cast<std::uint16_t>(1000 + u + 2 * v - (r2 < 100.0 ? 200 : 0));
  }
  static DepthImage depthOfFrame(int n) {
    DepthImage depth(kSequenceWidth, kSequenceHeight);
    for (int v = 0; v < kSequenceHeight; ++v)
      for (int u = 0; u < kSequenceWidth; ++u)
        if (const auto count = countOf(n, u, v)) depth.at(u, v) = static_cast<float>(count * 0.001);
    return depth;
  }

  RosImage imageOf(int n) const {
    RosImage image;
    image.topic = topic;
    image.stamp_ns = stampOf(0.1 * n);
    image.width = kSequenceWidth;
    image.height = kSequenceHeight;
    image.encoding = encoding;
    const DepthImage depth = depthOfFrame(n);
    const bool metres = encoding == "32FC1";
    image.step = kSequenceWidth * (metres ? 4 : 2) + 6;  // rows may be longer than their pixels
    image.data.resize(image.step * image.height);
    for (int v = 0; v < kSequenceHeight; ++v) {
      for (int u = 0; u < kSequenceWidth; ++u) {
        const std::uint16_t count = countOf(n, u, v);
        const float depth_m = depth.at(u, v);
        if (metres)
          std::memcpy(&image.data[v * image.step + u * 4], &depth_m, 4);
        else
          std::memcpy(&image.data[v * image.step + u * 2], &count, 2);
      }
    }
    if (change) change(n, image);
    return image;
  }

  static RosTransform transformOf(const std::string& parent, const std::string& child, std::int64_t stamp_ns,
                                  const Pose& pose) {
    const Eigen::Vector3d p = pose.translation();
    const Eigen::Quaterniond q = orientationOf(pose);
    return {parent, child, stamp_ns, {p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}};
  }

  void write(const std::string& path, BagPacking packing = BagPacking::None) const {
    BagWriter bag(path, packing);
    if (with_static_tf) bag.add(transformOf("base", "camera", 0, poseOfCamera()), "/tf_static");
    for (double t = 0.0; with_tf && t < 0.1 * frames; t += tf_step_s)
      bag.add(transformOf("/world", "base", stampOf(t), poseOfBase(t)));
    for (int n = 0; n < frames; ++n) {
      if (with_info)
        bag.add(RosCameraInfo{"/camera/depth/camera_info", kSequenceWidth, kSequenceHeight, K, D});
      bag.add(imageOf(n));
    }
    if (more) more(bag);
  }
};

}  // namespace vantage::test
