#include "viewer/captions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/synthetic_record.h"
#include "viewer/color.h"

namespace vantage {
namespace {

using testing::HasSubstr;

TEST(Captions, ThousandsAreSetApart) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1 000");
  EXPECT_EQ(grouped(34918400), "34 918 400");
}

TEST(Captions, SayWhyTheViewWasChosen) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  ASSERT_TRUE(run.record.hasView());
  const std::string text = viewFigures(run.frame());
  EXPECT_THAT(text, HasSubstr("View " + std::to_string(run.record.search->chosen->id) + " gains"));
  EXPECT_THAT(text, HasSubstr("threshold of 100 rays"));
  const std::size_t chosen = run.record.search->chosen->search;
  EXPECT_THAT(text, HasSubstr("no. " + std::to_string(chosen + 1) + " (label "));
  EXPECT_THAT(text, HasSubstr(", saliency "));
  EXPECT_THAT(stepLine(run.frame()), HasSubstr("step 1"));
  EXPECT_THAT(contourFigures(run.frame()),
              HasSubstr(grouped(run.record.contours->voxels.size()) + " contour voxel"));
  EXPECT_THAT(scanFigures(run.frame()), HasSubstr("12 frames"));
}

TEST(Captions, SayWhyNoneWasChosen) {
  const test::SyntheticRun run = test::makeSyntheticRun(false);
  EXPECT_THAT(viewFigures(run.frame()), HasSubstr("No view was chosen"));
  EXPECT_THAT(viewFigures(run.frame()), HasSubstr("0 above the threshold"));
}

TEST(Captions, CountUnknownAsTheGridDoes) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  const std::uint64_t unknown = run.states.count(VoxelState::Unknown, run.header.workspace);
  ASSERT_GT(unknown, 0u);
  EXPECT_THAT(stateFigures(run.frame()), HasSubstr("Unknown: " + grouped(unknown) + " of "));
}

TEST(Captions, StandardPlannerHasNoSegmentsToSpeakOf) {
  test::SyntheticRun run = test::makeSyntheticRun();
  run.header.planner = run.record.planner = "standard";
  run.record.saliency.reset();
  EXPECT_THAT(segmentFigures(run.frame()), HasSubstr("does not use segments"));
  EXPECT_THAT(viewFigures(run.frame()), HasSubstr("scored over the whole workspace. View "));
  EXPECT_THAT(viewFigures(run.frame()), testing::Not(HasSubstr("tried first")));
}

TEST(Captions, EmptyRunHasSentencesToo) {
  const test::SyntheticRun run = test::makeEmptyRun();
  for (const auto figures : {scanFigures, stateFigures, contourFigures, segmentFigures, viewFigures}) {
    EXPECT_NE(figures(run.frame()), "");
  }
}

TEST(Color, MapsRiseInLightnessFromEndToEnd) {
  for (const ColorMap map : {ColorMap::Viridis, ColorMap::Cividis}) {
    double before = -1.0;
    for (int i = 0; i <= 64; ++i) {
      const Rgb color = colorAt(map, i / 64.0);
      const double lightness = 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b;
      EXPECT_GT(lightness, before);
      before = lightness;
    }
    EXPECT_EQ(colorAt(map, -1.0), colorAt(map, 0.0));
    EXPECT_EQ(colorAt(map, 7.0), colorAt(map, 1.0));
  }
}

}  // namespace
}  // namespace vantage
