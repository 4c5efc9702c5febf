#include "io/camera_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/data_support.h"

namespace vantage {
namespace {

using testing::HasSubstr;

class CameraFile : public FolderTest {
 protected:
  std::string error(const std::string& text) {
    const auto path = write("c.yaml", text);
    return errorOf([&] { readCamera(path); });
  }
};

const char* const kRos = R"(image_width: 640
image_height: 480
camera_name: head
camera_matrix:
  rows: 3
  cols: 3
  data: [532.5, 0, 316.25, 0, 531.5, 236.5, 0, 0, 1]
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [0.1, 0, 0, 0, 0]}
)";

const char* const kOpenCv = R"(%YAML:1.0
---
calibration_time: "Tue 01 Jan"
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.325e+02, 0., 316.25, 0., 531.5, 236.5, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 1
   cols: 2
   dt: d
   data: [ 0., 0. ]
)";

void expectCamera(const PinholeCamera& camera) {
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.height, 480);
  EXPECT_EQ(camera.fx, 532.5);
  EXPECT_EQ(camera.fy, 531.5);
  EXPECT_EQ(camera.cx, 316.25);
  EXPECT_EQ(camera.cy, 236.5);
}

TEST_F(CameraFile, RosAndOpenCvFilesGiveTheSameCamera) {
  std::vector<std::string> warnings;
  expectCamera(readCamera(write("opencv.yaml", kOpenCv), {}, &warnings));
  EXPECT_TRUE(warnings.empty());
  PinholeCamera defaults;
  defaults.min_range_m = 0.3;
  const PinholeCamera camera = readCamera(write("ros.yaml", kRos), defaults, &warnings);
  expectCamera(camera);
  EXPECT_EQ(camera.min_range_m, 0.3);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("ros.yaml:9: lens distortion"));
  expectCamera(readCamera(write(
      "topic.yaml", "height: 480\nwidth: 640\nK: [532.5, 0.0, 316.25, 0, 531.5, 236.5, 0, 0, 1]\n---\n")));
}

TEST_F(CameraFile, WritingAndReadingGivesAnEqualCamera) {
  PinholeCamera camera;
  camera.fx = 1000.0 / 3.0;
  camera.cy = 0.1;
  camera.max_range_m = 2.75;
  writeCamera(folder_ / "c.yaml", camera);
  const PinholeCamera read = readCamera(folder_ / "c.yaml");
  EXPECT_EQ(read.fx, camera.fx);
  EXPECT_EQ(read.fy, camera.fy);
  EXPECT_EQ(read.cy, camera.cy);
  EXPECT_EQ(read.width, camera.width);
  EXPECT_EQ(read.max_range_m, camera.max_range_m);
}

TEST_F(CameraFile, MistakesAreRefusedByFileAndLine) {
  const std::string size = "image_width: 640\nimage_height: 480\n";
  EXPECT_THAT(errorOf([&] { readCamera(folder_ / "no.yaml"); }), HasSubstr("no.yaml: cannot be read"));
  EXPECT_THAT(error(""), HasSubstr("c.yaml: is not a camera file"));
  EXPECT_THAT(error("[1, 2]"), HasSubstr("is not a camera file"));
  EXPECT_THAT(error("a: [1, 2\nb: 3\n"), HasSubstr("broken YAML"));
  EXPECT_THAT(error("image_height: 3\n"), HasSubstr("has no 'image_width'"));
  EXPECT_THAT(error(size), HasSubstr("has no 'camera_matrix'"));
  EXPECT_THAT(error("image_width: 640\nimage_height: -1\n"),
              HasSubstr("c.yaml:2: image_height = -1 is out of range"));
  EXPECT_THAT(error("image_width: wide\n"), HasSubstr("c.yaml:1: image_width is not a finite number"));
  EXPECT_THAT(error(size + "K: [1, 2, 3]\n"), HasSubstr("c.yaml:3: camera_matrix holds 3 numbers"));
  EXPECT_THAT(error(size + "K: [1, 2, 3, 4, 5, 6, 7, 8, 9]\n"), HasSubstr("fx 0 cx"));
  EXPECT_THAT(error(size + "K: [x, 0, 3, 0, 5, 6, 0, 0, 1]\n"),
              HasSubstr("c.yaml:3: camera_matrix is not a finite"));
  EXPECT_THAT(error(size + "K: 3\n"), HasSubstr("is not a list of numbers"));
  EXPECT_THAT(error(size + "K: [0, 0, 3, 0, 5, 6, 0, 0, 1]\n"), HasSubstr("camera.fx"));
}

}  // namespace
}  // namespace vantage
