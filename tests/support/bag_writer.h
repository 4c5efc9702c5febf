#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vantage::test {

enum class BagPacking { None, Bz2, Lz4 };

struct RosImage {
  std::string topic = "/camera/depth/image_raw", frame = "camera";
  std::int64_t stamp_ns = 0;
  std::uint32_t width = 0, height = 0, step = 0;
  std::string encoding = "16UC1";
  bool big_endian = false;
  std::vector<std::uint8_t> data;
};

struct RosCameraInfo {
  std::string topic = "/camera/depth/camera_info";
  std::uint32_t width = 0, height = 0;
  std::array<double, 9> K{};
  std::vector<double> D;
};

struct RosTransform {
  std::string parent, child;
  std::int64_t stamp_ns = 0;
  std::array<double, 3> position_m{};
  std::array<double, 4> quaternion_xyzw{0, 0, 0, 1};
};

/// Writes a bag with ROS's own library. Messages are recorded one millisecond apart in the order of the
/// calls.
class BagWriter {
 public:
  explicit BagWriter(const std::string& path, BagPacking packing = BagPacking::None);
  ~BagWriter();  ///< closes the bag

  void add(const RosImage& image);
  void add(const RosCameraInfo& info);
  void add(const RosTransform& transform, const std::string& topic = "/tf");
  void addCompressedImage(const std::string& topic);
  void addText(const std::string& topic);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage::test
