#include "viewer/captions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/synthetic_record.h"
#include "viewer/color.h"
#include "viewer/segment_scores.h"
#include "viewer/step_data.h"

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
  const std::string text = viewFigures(run.frame(), {});
  EXPECT_THAT(text, HasSubstr("View " + std::to_string(run.record.search->chosen->id) + " gains"));
  EXPECT_THAT(text, HasSubstr("threshold of 100 rays"));
  const std::size_t chosen = run.record.search->chosen->search;
  EXPECT_THAT(text, HasSubstr("no. " + std::to_string(chosen + 1) + " (label "));
  EXPECT_THAT(text, HasSubstr(", saliency "));
  EXPECT_THAT(stepLine(run.frame()), HasSubstr("step 1"));
  EXPECT_THAT(contourFigures(run.frame(), {}),
              HasSubstr(grouped(run.record.contours->voxels.size()) + " contour voxel"));
  EXPECT_THAT(scanFigures(run.frame(), {}), HasSubstr("12 frames"));
}

TEST(Captions, NameWhatTheGainCounts) {
  test::SyntheticRun run = test::makeSyntheticRun();
  run.header.contour_config.gain.count = GainMeasure::Voxels;
  const std::string text = viewFigures(run.frame(), {});
  EXPECT_THAT(text, HasSubstr("threshold of 100 voxels"));
  EXPECT_THAT(text, testing::Not(HasSubstr("rays")));
}

TEST(Captions, SayWhyNoneWasChosen) {
  const test::SyntheticRun run = test::makeSyntheticRun(false);
  EXPECT_THAT(viewFigures(run.frame(), {}), HasSubstr("No view was chosen"));
  EXPECT_THAT(viewFigures(run.frame(), {}), HasSubstr("0 above the threshold"));
}

TEST(Captions, CountUnknownAsTheGridDoes) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  const std::uint64_t unknown = run.states.count(VoxelState::Unknown, run.header.workspace);
  ASSERT_GT(unknown, 0u);
  EXPECT_THAT(stateFigures(run.frame(), {}), HasSubstr("Unknown: " + grouped(unknown) + " of "));
}

TEST(Captions, StandardPlannerHasNoSegmentsToSpeakOf) {
  test::SyntheticRun run = test::makeSyntheticRun();
  run.header.planner = run.record.planner = "standard";
  run.record.saliency.reset();
  EXPECT_THAT(segmentFigures(run.frame(), {}), HasSubstr("does not use segments"));
  EXPECT_THAT(viewFigures(run.frame(), {}), HasSubstr("scored over the whole workspace. View "));
  EXPECT_THAT(viewFigures(run.frame(), {}), testing::Not(HasSubstr("tried first")));
}

TEST(Captions, SaySegmentsInTheOrderThatTheStyleAsksFor) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  LayerStyle style;
  EXPECT_THAT(segmentFigures(run.frame(), style), HasSubstr("Tried in the order of saliency: no. 1 (label "));
  style.saliency_part = SaliencyPart::Isolation;
  style.isolation_distance_m = 0.05;
  const std::vector<Segment> segments = shownSegments(run.frame(), style);
  const std::vector<std::uint32_t> order = shownOrder(run.frame(), style);
  ASSERT_EQ(order.size(), run.record.search->segments.size());
  ASSERT_GE(order.size(), 2u);
  SaliencyConfig config = run.header.contour_config.saliency;
  config.isolation_distance_m = 0.05;
  config.use_roundness = false;
  const Saliency fresh = computeSaliency(*run.record.surface, *run.record.labels, config);
  for (std::size_t i = 0; i < segments.size(); ++i)
    EXPECT_DOUBLE_EQ(segments[i].saliency, fresh.segments[i].saliency);
  double last = 1.0;
  for (const std::uint32_t group : order) {
    const std::int32_t segment = run.record.search->segments[group].segment;
    const double saliency = segment < 0 ? 0.0 : segments[static_cast<std::size_t>(segment)].saliency;
    EXPECT_LE(saliency, last);
    last = saliency;
  }
  const std::int32_t first = run.record.search->segments[order[0]].segment;
  ASSERT_GE(first, 0);
  EXPECT_THAT(segmentFigures(run.frame(), style),
              HasSubstr("By isolation F, B_th = 5 cm they would be tried in this order: no. 1 (label " +
                        std::to_string(segments[static_cast<std::size_t>(first)].label)));
  style.isolation_distance_m = 0.5;
  EXPECT_THROW(shownSegments(run.frame(), style), std::invalid_argument)
      << "no distances are kept so far out";
}

TEST(Captions, TellNormalsApartAndCountThePosesOfAPoint) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  EXPECT_THAT(normalFigures(run.frame(), {}),
              HasSubstr("At " + std::to_string(run.record.contours->points.size()) + " contour point"));
  EXPECT_THAT(poseFigures(run.frame(), {}), HasSubstr("generates 40 poses"));
  EXPECT_THAT(poseFigures(run.frame(), {}),
              HasSubstr("View " + std::to_string(run.record.search->chosen->id) + " is one"));
  EXPECT_THAT(poseFigures(test::makeEmptyRun().frame(), {}), HasSubstr("no contour points"));
  EXPECT_THAT(normalFigures(test::makeEmptyRun().frame(), {}), HasSubstr("no contour points"));
}

TEST(Captions, EmptyRunHasSentencesToo) {
  const test::SyntheticRun run = test::makeEmptyRun();
  for (const auto figures : {scanFigures, stateFigures, contourFigures, segmentFigures, viewFigures,
                             octreeFigures, rayFigures, utilityFigures}) {
    EXPECT_NE(figures(run.frame(), {}), "");
  }
}

TEST(Captions, SayHowTheUtilityOfTheChosenViewCameAbout) {
  const test::SyntheticOctreeRun run = test::makeSyntheticOctreeRun();
  const UtilitySearch& search = *run.record.utilities;
  const ViewUtility* chosen = chosenUtility(search);
  ASSERT_NE(chosen, nullptr);
  const std::string text = utilityFigures(run.frame(), {});
  EXPECT_THAT(viewFigures(run.frame(), {}), testing::StartsWith(text + " Path: "));
  EXPECT_THAT(text, HasSubstr("View " + std::to_string(chosen->id) + ": " +
                              grouped(static_cast<std::uint64_t>(chosen->unknown)) + " unknown and " +
                              grouped(static_cast<std::uint64_t>(chosen->occupied)) + " known rays in"));
  EXPECT_THAT(text, HasSubstr(" (seen rays per unknown voxel) × distance factor "));
  EXPECT_THAT(text, HasSubstr(grouped(search.rejected_position) + " fell out by position"));
  EXPECT_THAT(text, HasSubstr(grouped(search.rejected_registration) + " by registration"));
  EXPECT_THAT(text, HasSubstr("2 better ones are unreachable"));
  // The two best are unreachable, the third is chosen: the fourth would have been next.
  EXPECT_THAT(text,
              HasSubstr("Next best: view " + std::to_string(search.views[search.ranking.at(3)].id) + ", "));
}

TEST(Captions, SayThatNoViewSeesEnough) {
  const test::SyntheticOctreeRun run = test::makeSyntheticOctreeRun(CandidateGenerator::Icosphere, false);
  EXPECT_THAT(utilityFigures(run.frame(), {}), HasSubstr("No view was chosen: the best of the "));
}

TEST(Captions, TellReachabilityFromTooLittleUnknownAndFromNoViewAtAll) {
  test::SyntheticOctreeRun run = test::makeSyntheticOctreeRun();
  UtilitySearch search = *run.record.utilities;
  search.chosen.reset();
  for (const std::uint32_t n : search.ranking) search.views[n].reachability = Reachability::NoPath;
  search.counts.poses_unreachable = search.ranking.size();
  run.record.utilities = std::make_shared<UtilitySearch>(search);
  ASSERT_GT(search.counts.poses_above_threshold, 1u);
  EXPECT_THAT(utilityFigures(run.frame(), {}),
              testing::StartsWith("No view was chosen: " + grouped(search.counts.poses_above_threshold) +
                                  " see enough, 100 unknown rays or more, but none can be reached. Of "));
  for (const std::uint32_t n : search.ranking) search.views[n].reachability = Reachability::NoFrame;
  run.record.utilities = std::make_shared<UtilitySearch>(search);
  EXPECT_THAT(utilityFigures(run.frame(), {}), HasSubstr("but no recorded frame is left near any of them."));
  search.ranking.clear();
  search.best_unknown = 0.0;
  search.counts.poses_executed_before = 2;
  run.record.utilities = std::make_shared<UtilitySearch>(search);
  EXPECT_THAT(utilityFigures(run.frame(), {}), testing::StartsWith("No view was chosen: none is left. Of "));
  EXPECT_THAT(utilityFigures(run.frame(), {}), HasSubstr(", 2 were taken before."));
}

TEST(Captions, SayThatTheChosenViewSeesLessThanTheStopRuleAsks) {
  test::SyntheticOctreeRun run = test::makeSyntheticOctreeRun();
  EXPECT_THAT(utilityFigures(run.frame(), {}), testing::Not(HasSubstr("another view sees")));
  const double seen = chosenUtility(*run.record.utilities)->unknown;
  run.header.octree->planner.stop_gain = seen + 1.0;
  EXPECT_THAT(utilityFigures(run.frame(), {}),
              HasSubstr("That is fewer than the " + grouped(static_cast<std::uint64_t>(seen) + 1) +
                        " of the stop rule; another view sees "));
}

TEST(Captions, OctreeNodesAreCountedAtTheDepthThatIsDrawn) {
  const test::SyntheticOctreeRun run = test::makeSyntheticOctreeRun();
  LayerStyle style;
  style.octree_level = 3;
  EXPECT_THAT(octreeFigures(run.frame(), style), HasSubstr("Depth 13 of the octree, nodes of 8 cm"));
  const Box box = nodesInBox(run.frame(), 3);
  EXPECT_THAT(octreeFigures(run.frame(), style),
              HasSubstr("Nodes that meet the object's box: " +
                        grouped(run.pyramid.level(3).count(VoxelState::Occupied, box)) + " occupied, " +
                        grouped(run.pyramid.level(3).count(VoxelState::Unknown, box)) + " unknown"));
  for (const int level : {0, 5, 8}) {  // the box holds unknown, so some node does
    style.octree_level = level;
    EXPECT_THAT(octreeFigures(run.frame(), style), testing::Not(HasSubstr("0 occupied, 0 unknown, 0 free")));
  }
  EXPECT_THAT(octreeFigures(run.frame(), {}), HasSubstr("nodes of 4 cm"));  // where tracing starts, m = 2
}

TEST(Captions, RaysAreThoseOfTheStyleView) {
  const test::SyntheticOctreeRun run = test::makeSyntheticOctreeRun();
  LayerStyle style;
  style.view_id = 5;
  EXPECT_THAT(rayFigures(run.frame(), style), testing::StartsWith("View 5: "));
  const ViewUtility& chosen = *chosenUtility(*run.record.utilities);
  EXPECT_THAT(rayFigures(run.frame(), {}),
              HasSubstr("Counted: " + grouped(chosen.rays.unknown) + " finest rays on unknown, " +
                        grouped(chosen.rays.occupied) +
                        " on occupied; a ray that ends coarse counts for all finest ones below it."));
}

TEST(Captions, ProductsOfTheOtherPlannerDoNotExist) {
  const test::SyntheticOctreeRun octree = test::makeSyntheticOctreeRun();
  EXPECT_THAT(contourFigures(octree.frame(), {}), HasSubstr("has no contours"));
  EXPECT_THAT(segmentFigures(octree.frame(), {}), HasSubstr("has no segments"));
  const test::SyntheticRun contour = test::makeEmptyRun();
  for (const auto figures : {octreeFigures, rayFigures, utilityFigures})
    EXPECT_THAT(figures(contour.frame(), {}), HasSubstr("does not exist"));
}

TEST(Captions, LengthsHaveTheUnitThatSuitsThem) {
  EXPECT_EQ(lengthText(0.01), "1 cm");
  EXPECT_EQ(lengthText(0.08), "8 cm");
  EXPECT_EQ(lengthText(3.0 / 512.0), "5.9 mm");
  EXPECT_EQ(lengthText(0.025), "2.5 cm");
  EXPECT_EQ(lengthText(1.28), "1.3 m");
}

TEST(Captions, GiveVolumesInTheUnitThatSuitsThem) {
  EXPECT_EQ(volumeText(0.0), "0.00 cm³");
  EXPECT_EQ(volumeText(420e-6), "420 cm³");
  EXPECT_EQ(volumeText(8.637e-3), "8.64 dm³");
  EXPECT_EQ(volumeText(86.37e-3), "86.4 dm³");
  EXPECT_EQ(volumeText(1.0), "1.00 m³");
}

TEST(StepData, UnknownSpaceOfTwoPlannersIsComparedInCubicMetres) {
  RunHeader header;
  header.planner = "contour,hierarchical";
  header.volume.voxel_size_m = 0.01;
  header.octree.emplace().map.voxel_size_m = 0.02;
  StepSummary step;
  step.unknown_voxels = 8000;
  EXPECT_DOUBLE_EQ(unknownVolume_m3(header, step), 8e-3) << "the run's first planner";
  step.planner = "hierarchical";
  EXPECT_DOUBLE_EQ(unknownVolume_m3(header, step), 64e-3);
  step.planner = "of next year";
  EXPECT_DOUBLE_EQ(unknownVolume_m3(header, step), 8e-3);
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
