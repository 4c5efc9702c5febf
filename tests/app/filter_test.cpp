// `vantage filter`: depth pre-processing of images, made up and recorded.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "io/camera_file.h"
#include "io/depth_png.h"
#include "tests/app/program.h"

namespace vantage::test {
namespace {

using Json = nlohmann::json;

class Filter : public testing::Test {
 protected:
  /// Object of 1 m at columns 236..275, rows 112..311, before a background of 2.5 m (12.8).
  static DepthImage object() {
    DepthImage depth(512, 424);
    for (int v = 0; v < 424; ++v)
      for (int u = 0; u < 512; ++u)
        depth.at(u, v) = u >= 236 && u <= 275 && v >= 112 && v <= 311 ? 1.0f : 2.5f;
    return depth;
  }
  void SetUp() override {
    writeDepthPng(folder_.path() / "depth.png", object());
    writeCamera(folder_.path() / "camera.yaml", PinholeCamera());
  }
  ProcessResult filter(std::vector<std::string> words, const std::string& depth = "depth.png") {
    words.insert(words.begin(),
                 {"filter", folder_ / depth, "-o", folder_ / "out.png", "--json", folder_ / "counts.json"});
    if (std::ranges::find(words, "--camera") == words.end())
      words.insert(words.end(), {"--camera", folder_ / "camera.yaml"});
    return vantage(words);
  }
  Json counts() const { return Json::parse(readFile(folder_.path() / "counts.json")); }

  TemporaryFolder folder_;
};

TEST_F(Filter, RemovesShadowAndVeilAndSaysWhichInTheMask) {
  const ProcessResult result =
      filter({"--no-bilateral", "--mask", folder_ / "mask.png", "--picture", folder_ / "picture.png"});
  ASSERT_EQ(result.code, 0) << result.err;
  const Json c = counts();
  EXPECT_EQ(c["shadow"].get<int>() + c["both"].get<int>(), 3400);
  EXPECT_EQ(c["veil"].get<int>() + c["both"].get<int>(), 956);
  EXPECT_EQ(c["kept"], 212932);
  const DepthImage out = readDepthPng(folder_.path() / "out.png");
  EXPECT_EQ(std::ranges::count_if(out.depth_m, DepthImage::valid), 212932);
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "mask.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "picture.png"));
  EXPECT_NE(result.out.find("212932 of 217088 measured pixels kept"), std::string::npos) << result.out;
}

TEST_F(Filter, SwitchesAndSidesChangeWhatTheySay) {
  ASSERT_EQ(filter({"--no-bilateral", "--no-veil"}).code, 0);
  EXPECT_EQ(counts()["shadow"], 3400);
  EXPECT_EQ(counts()["veil"], 0);
  ASSERT_EQ(filter({"--no-bilateral", "--no-shadow"}).code, 0);
  EXPECT_EQ(counts()["veil"], 956);
  EXPECT_EQ(counts()["shadow"], 0);
  ASSERT_EQ(filter({"--no-bilateral", "--no-shadow", "--no-veil"}).code, 0);
  EXPECT_EQ(counts()["kept"], 217088);
  ASSERT_EQ(filter({"--no-bilateral", "--no-veil", "--emitter-offset", "0.04"}).code, 0);
  EXPECT_EQ(counts()["shadow"], 1600) << "half the offset, half the width: 8 columns";
  ASSERT_EQ(
      filter({"--no-bilateral", "--no-veil", "--emitter-side", "right", "--mask", folder_ / "m.png"}).code,
      0);
  EXPECT_EQ(counts()["shadow"], 3400);
  const DepthImage out = readDepthPng(folder_.path() / "out.png");
  EXPECT_FALSE(DepthImage::valid(out.at(225, 200))) << "the shadow is on the left now";
  EXPECT_TRUE(DepthImage::valid(out.at(285, 200)));
}

TEST_F(Filter, ImagesOfNothingAndOfOneRowHaveADefinedResult) {
  writeDepthPng(folder_.path() / "empty.png", DepthImage(512, 424));
  ASSERT_EQ(filter({}, "empty.png").code, 0);
  EXPECT_EQ(counts()["invalid"], 217088);
  DepthImage row(512, 1);
  for (int u = 0; u < 512; ++u) row.at(u, 0) = u >= 236 && u <= 275 ? 1.0f : 2.5f;
  writeDepthPng(folder_.path() / "row.png", row);
  PinholeCamera line;
  line.height = 1;
  line.cy = 0.0;
  writeCamera(folder_.path() / "line.yaml", line);
  ASSERT_EQ(filter({"--camera", folder_ / "line.yaml"}, "row.png").code, 0);
  EXPECT_EQ(counts()["shadow"].get<int>() + counts()["both"].get<int>(), 17);
}

TEST_F(Filter, WhatCannotBeIsRefusedInOneLine) {
  writeFile(folder_.path() / "blind.yaml", "image_width: 512\nimage_height: 424\n");
  expectRefused(filter({"--camera", folder_ / "blind.yaml"}), {"blind.yaml", "camera_matrix"});
  writeFile(folder_.path() / "zero.yaml",
            "image_width: 512\nimage_height: 424\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
            "  data: [0, 0, 255.5, 0, 0, 211.5, 0, 0, 1]\n");
  expectRefused(filter({"--camera", folder_ / "zero.yaml"}), {"zero.yaml"});
  expectRefused(filter({"--emitter-offset", "0"}), {"--emitter-offset", "--no-shadow"});
  expectRefused(filter({"--emitter-offset", "-0.08"}), {"--emitter-offset"});
  expectRefused(filter({"--emitter-side", "above"}), {"--emitter-side"});
  PinholeCamera other;
  other.width = 640;
  writeCamera(folder_.path() / "other.yaml", other);
  expectRefused(filter({"--camera", folder_ / "other.yaml"}), {"depth.png", "512x424", "640x424"});
  expectRefused(filter({}, "gone.png"), {"gone.png"});
  expectRefused(filter({"--set", "filter.veil_angle_deg=200"}), {"filter.veil_angle_deg"});
  expectRefused(filter({"--mask", folder_ / "out.png"}), {"out.png"});
  expectRefused(filter({"--set", "filter.veil=false"}), {"filter.veil=false", "--no-veil"});
}

/// A pixel that lies between its two horizontal neighbours by more than 30 mm each way.
struct FlyingPixel {
  int u = 0, v = 0, depth_mm = 0;
  int largest_step_mm = 0;  ///< to the farther of the two, in depth
  /// Depth step between neighbours at which eq. (19) sees a grazing angle (12.8's rule of thumb).
  double grazingStep_mm(double focal_px) const {
    return depth_mm / (focal_px * std::tan(10 * std::numbers::pi / 180));
  }
};

std::vector<FlyingPixel> flyingPixels(const DepthImage& depth) {
  const auto mm = [&](int u, int v) {
    const float z = depth.at(u, v);
    return DepthImage::valid(z) ? static_cast<int>(std::lround(1000 * z)) : 0;
  };
  std::vector<FlyingPixel> found;
  for (int v = 0; v < depth.height; ++v)
    for (int u = 1; u + 1 < depth.width; ++u) {
      const int left = mm(u - 1, v), here = mm(u, v), right = mm(u + 1, v);
      if (left == 0 || here == 0 || right == 0) continue;
      if (std::min(here - left, right - here) <= 30 && std::min(left - here, here - right) <= 30) continue;
      found.push_back({u, v, here, std::max(std::abs(here - left), std::abs(right - here))});
    }
  return found;
}

TEST_F(Filter, RemovesTheFlyingPixelsOfARecordedKinectV2) {
  const std::filesystem::path frames = std::filesystem::path(VANTAGE_TEST_DATA) / "kinect2_qhd_mine";
  if (!std::filesystem::is_directory(frames)) GTEST_SKIP() << "the recorded frames are not there";
  const PinholeCamera camera{
      .width = 960, .height = 540, .fx = 519.226, .fy = 522.23, .cx = 479.462, .cy = 272.737};
  writeCamera(folder_.path() / "qhd.yaml", camera);
  const struct {
    const char* name;
    std::size_t before, steep, removed, after;
  } expected[] = {{"data-0000-depth.png", 400, 156, 222, 93}, {"data-0001-depth.png", 638, 221, 302, 154}};
  for (const auto& frame : expected) {
    const DepthImage measured = readDepthPng(frames / frame.name);
    const ProcessResult result =
        vantage({"filter", (frames / frame.name).string(), "--camera", folder_ / "qhd.yaml", "-o",
                 folder_ / "out.png", "--json", folder_ / "counts.json"});
    ASSERT_EQ(result.code, 0) << result.err;
    const DepthImage out = readDepthPng(folder_.path() / "out.png");
    const std::vector<FlyingPixel> before = flyingPixels(measured), after = flyingPixels(out);
    EXPECT_EQ(before.size(), frame.before);
    std::size_t steep = 0, removed = 0;
    for (const FlyingPixel& pixel : before) {
      const bool gone = !DepthImage::valid(out.at(pixel.u, pixel.v));
      removed += gone;
      if (pixel.largest_step_mm <= 1.1 * pixel.grazingStep_mm(camera.fx)) continue;
      ++steep;
      EXPECT_TRUE(gone) << pixel.u << ", " << pixel.v;
    }
    EXPECT_EQ(steep, frame.steep);
    EXPECT_NEAR(static_cast<double>(removed), static_cast<double>(frame.removed), 5);
    EXPECT_NEAR(static_cast<double>(after.size()), static_cast<double>(frame.after), 5);
    for (const FlyingPixel& pixel : after) {  // what is left is no steeper than eq. (19) allows, far away
      EXPECT_LE(pixel.largest_step_mm, 1.05 * pixel.grazingStep_mm(camera.fx));
      EXPECT_GT(pixel.depth_mm, 2500);
    }
    const auto valid = static_cast<double>(std::ranges::count_if(measured.depth_m, DepthImage::valid));
    EXPECT_GT(counts()["kept"].get<double>(), 0.9 * valid) << "most of the image stays";
  }
}

}  // namespace
}  // namespace vantage::test
