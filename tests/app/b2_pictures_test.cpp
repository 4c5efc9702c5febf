#include "viewer/app/experiments/b2_pictures.h"

#include <gmock/gmock.h>
#include <png.h>

#include <algorithm>
#include <cstdlib>
#include <stop_token>

#include "tests/support/process.h"
#include "viewer/app/experiments/b1_segments.h"
#include "viewer/app/experiments/b2_noise.h"
#include "viewer/app/experiments/b2_normals.h"
#include "viewer/color.h"
#include "viewer/image.h"

namespace vantage::experiments {
namespace {

using ::testing::HasSubstr;

RgbImage decoded(const std::string& png) {
  png_image info{};
  info.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&info, png.data(), png.size())) return {};
  info.format = PNG_FORMAT_RGB;
  RgbImage image(static_cast<int>(info.width), static_cast<int>(info.height));
  if (!png_image_finish_read(&info, nullptr, image.pixels.data(), 0, nullptr)) return {};
  return image;
}

const FirstStep& first() {
  static const FirstStep step = firstStep({});
  return step;
}

const Report& pictures() {
  static const Report report = [] {
    Report made;
    addSaliencyPictures(first(), {}, made);
    return made;
  }();
  return report;
}

const Picture& pictureOf(const std::string& name) {
  for (const Picture& picture : pictures().pictures)
    if (picture.name == name) return picture;
  throw std::runtime_error("no picture " + name);
}

/// Pixels that differ in the scene, at the left of the legend and below the caption.
int different(const std::string& a, const std::string& b) {
  const RgbImage first = decoded(pictureOf(a).png), second = decoded(pictureOf(b).png);
  int count = 0;
  for (int y = 100; y < first.height; ++y)
    for (int x = 0; x < first.width * 3 / 4; ++x) count += first.at(x, y) != second.at(x, y);
  return count;
}

TEST(SaliencyEnds, AreOfTheMostSalientOtherAndOfTheLeastObjectByItsBestSegment) {
  const std::vector<SegmentRow> rows = {
      {0.5, 1, 1, "jug"}, {0.1, 1, 1, "jug"}, {0.3, 1, 1, "box"}, {0.2, 1, 1, ""}, {0.05, 1, 1, ""}};
  EXPECT_EQ(saliencyEnds(rows).other, 0.2);
  EXPECT_EQ(saliencyEnds(rows).object, 0.3);
  EXPECT_EQ(saliencyEnds({}).object, 0.0);
}

TEST(SaliencyPictures, AreThoseOfBothFiguresInOneSize) {
  ASSERT_EQ(pictures().notes, std::vector<std::string>{});
  ASSERT_EQ(pictures().pictures.size(), 8u);
  for (const Picture& picture : pictures().pictures) {
    const RgbImage image = decoded(picture.png);
    EXPECT_EQ(image.width, 1120) << picture.name;
    EXPECT_EQ(image.height, 700) << picture.name;
    EXPECT_THAT(picture.caption, HasSubstr("no object: 0."));
  }
  EXPECT_THAT(pictureOf("b2_saliency_b_th_0.005").caption, HasSubstr("B_th 5 mm"));
  EXPECT_THAT(pictureOf("b2_saliency").caption, HasSubstr("B_th 2 cm"));
}

TEST(SaliencyPictures, DifferWhereTheSaliencyDoes) {
  EXPECT_EQ(different("b2_saliency", "b2_saliency_b_th_0.02"), 0) << "0.02 m is the default";
  const char* names[] = {"b2_saliency_b_th_0.005", "b2_saliency_b_th_0.01", "b2_saliency",
                         "b2_saliency_b_th_0.05",  "b2_saliency_b_th_0.1",  "b2_saliency_roundness",
                         "b2_saliency_isolation"};
  for (const char* a : names)
    for (const char* b : names) {
      if (a != b) {
        EXPECT_GT(different(a, b), 5000) << a << ", " << b;
      }
    }
}

TEST(SaliencyPictures, ShowWhatTheyClaim) {
  // The table is nearly all isolated and flat: bright by isolation, dark by roundness.
  const auto share = [](const std::string& name, auto wanted) {
    const RgbImage image = decoded(pictureOf(name).png);
    int count = 0;
    for (int y = 100; y < image.height; ++y)
      for (int x = 0; x < image.width * 3 / 4; ++x) count += wanted(image.at(x, y));
    return static_cast<double>(count) / (image.width * 3 / 4 * (image.height - 100));
  };
  const auto yellow = [](const auto& p) { return p[0] > 120 && p[1] > 120 && p[2] < 90; };
  const auto purple = [](const auto& p) { return p[0] < 90 && p[1] < 40 && p[2] > 40; };
  EXPECT_GT(share("b2_saliency_isolation", yellow), 0.2);
  EXPECT_GT(share("b2_saliency_roundness", purple), 0.2);
  EXPECT_LT(share("b2_saliency_roundness", yellow), 0.1);
}

TEST(SaliencyPictures, StopWhenAskedTo) {
  std::stop_source source;
  source.request_stop();
  RunControl control;
  control.stop = source.get_token();
  Report report;
  EXPECT_THROW(addSaliencyPictures(first(), control, report), Cancelled);
  EXPECT_TRUE(report.pictures.empty());
}

TEST(CompareNormals, ViewBGainsLessAtTheBoxesOfS1) {
  const std::vector<NormalsAtObject> objects = compareNormals(first());
  ASSERT_EQ(objects.size(), 5u);
  for (const NormalsAtObject& at : objects) {
    EXPECT_GT(at.frontier.contour_points, 5u) << at.object;
    EXPECT_GT(at.frontier.best, 700.0) << at.object;
    EXPECT_GE(at.frontier.best, at.frontier.mean) << at.object;
    if (at.object.starts_with("box")) {
      EXPECT_LT(at.ratio(&ObjectGain::mean), 1.0) << at.object;
    }
  }
  EXPECT_EQ(normalsTable(objects).rows.size(), 5u);
  EXPECT_NE(judgeNormals(objects).verdict, Verdict::NotRun);
  EXPECT_EQ(judgeNormals({}).verdict, Verdict::NotRun);
}

TEST(NoiseRanks, AreThoseOfRoundnessAloneAndOfTheWholeSaliency) {
  const NoiseRanks ideal = rankNoise(first());
  EXPECT_GT(ideal.others, 0u);
  EXPECT_EQ(ideal.above_by_saliency, 0u);
  EXPECT_EQ(judgeNoise({10, 3, 1}).verdict, Verdict::Pass);
  EXPECT_EQ(judgeNoise({10, 3, 3}).verdict, Verdict::Missed);
  EXPECT_EQ(judgeNoise({10, 0, 0}).verdict, Verdict::NotComparable);
  const NoiseRanks noisy = rankNoise(firstStep({}, noisySettings()));
  EXPECT_GT(noisy.others, ideal.others) << "faults leave segments of their own";
  EXPECT_LE(noisy.above_by_saliency, noisy.others);
}

TEST(CompareNormals, IsJudgedByTheBestPose) {
  const auto at = [](const char* object, double surface) {
    return NormalsAtObject{object, {10, 1000.0, 500.0}, {10, surface, 500.0}};
  };
  EXPECT_EQ(judgeNormals({at("box", 500), at("ball", 1000)}).verdict, Verdict::Pass);
  EXPECT_EQ(judgeNormals({at("box", 1100), at("ball", 1000)}).verdict, Verdict::Missed);
  EXPECT_EQ(judgeNormals({at("box", 500), at("ball", 700)}).verdict, Verdict::Missed);
}

/// EGL looks for drivers once a process: this test does in one of its own.
TEST(SaliencyPictures, AreLeftOutWithAdviceWithoutOpenGl) {
  if (!std::getenv("VANTAGE_TEST_WITHOUT_GL")) {
    const char* name = "--gtest_filter=SaliencyPictures.AreLeftOutWithAdviceWithoutOpenGl";
    test::ProcessOptions alone;
    alone.environment = {{"VANTAGE_TEST_WITHOUT_GL", "1"}, {"__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent"}};
    const test::ProcessResult result = test::runProcess({"/proc/self/exe", name}, alone);
    EXPECT_EQ(result.code, 0) << result.out;
    return;
  }
  Report report;
  addSaliencyPictures({}, {}, report);
  EXPECT_TRUE(report.pictures.empty());
  ASSERT_EQ(report.notes.size(), 1u);
  EXPECT_THAT(report.notes[0], HasSubstr("left out: "));
  EXPECT_THAT(report.notes[0], HasSubstr("libegl-mesa0"));
}

}  // namespace
}  // namespace vantage::experiments
