#pragma once

#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

#include "io/dataset.h"
#include "tests/io/data_support.h"

namespace vantage {

inline std::string poseText(const Eigen::Matrix4d& matrix) {
  std::ostringstream text;
  text << std::setprecision(17) << matrix << "\n";
  return text.str();
}

/// A small recorded sequence: a camera on a line looks straight at the wall z = 2 of its own frame.
class DatasetTest : public FolderTest {
 protected:
  static constexpr int kWidth = 8, kHeight = 6;

  static Pose poseOf(int number) { return Pose(Eigen::Translation3d(0.1 * number, 0.0, 0.0)); }
  static DepthImage wall(float depth_m, int width = kWidth, int height = kHeight) {
    DepthImage image(width, height);
    for (float& d : image.depth_m) d = depth_m;
    return image;
  }
  static std::string frameName(int number) {
    std::ostringstream name;
    name << "frame-" << std::setw(6) << std::setfill('0') << number;
    return name.str();
  }
  void addFrame(int number, const std::string& where = "frames/") {
    std::filesystem::create_directories(folder_ / where);
    writeDepthPng(folder_ / (where + frameName(number) + ".depth.png"), wall(2.0f));
    write(where + frameName(number) + ".pose.txt", poseText(poseOf(number).matrix()));
  }
  void addSequence(const std::string& where = "frames/") {
    for (const int number : {12, 3, 7}) addFrame(number, where);
    write("camera-intrinsics.txt", "10 0 3.5\n0 11 2.5\n0 0 1\n");
  }
};

}  // namespace vantage
