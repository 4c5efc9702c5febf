// The acceptance of the whole loop on the embedded scene `tabletop`: initial scan, five next best views,
// closing scan.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "tests/support/simulated_run.h"

namespace vantage {
namespace {

using testing::exploreScene;
using testing::SimulatedRun;

/// Farthest distance of a mesh vertex from the object it shows, metres: noise and half a voxel.
constexpr double kOnSurface_m = 0.012;

/// One run serves all tests of its thread count.
const SimulatedRun& tabletop(int threads = 2) {
  static std::map<int, SimulatedRun> runs;
  auto found = runs.find(threads);
  if (found == runs.end())
    found =
        runs.emplace(threads, exploreScene("tabletop", testing::sceneSettings("tabletop"), threads)).first;
  return found->second;
}

/// True object of each point of the surface cloud, -1 = none (table, panel).
std::vector<int> trueObjects(const SimulatedRun& run, const StepRecord& step) {
  std::vector<int> objects;
  for (const Eigen::Vector3f& p : step.surface->points)
    objects.push_back(run.truth->objectAt(p.cast<double>(), kOnSurface_m));
  return objects;
}

/// True object of a segment by the majority of its points, -1 = none; index = label.
std::vector<int> segmentObjects(const StepRecord& step, const std::vector<int>& objects) {
  std::vector<std::map<int, int>> votes(step.labels->count + 1);
  for (std::size_t n = 0; n < objects.size(); ++n) ++votes[step.labels->of_point[n]][objects[n]];
  std::vector<int> majority(votes.size(), -1);
  for (std::size_t label = 1; label < votes.size(); ++label)
    majority[label] =
        std::max_element(votes[label].begin(), votes[label].end(), [](const auto& a, const auto& b) {
          return a.second < b.second;
        })->first;
  return majority;
}

TEST(Tabletop, RunsFiveViewsAndAClosingScan) {
  const SimulatedRun& run = tabletop();
  EXPECT_EQ(run.stop_reason, "steps done");
  ASSERT_EQ(run.steps.size(), 5u);
  EXPECT_TRUE(run.closing.closing);
  for (const StepRecord& step : run.steps) {
    ASSERT_TRUE(step.hasView());
    EXPECT_GT(step.search->chosen->gain, 700.0);
    EXPECT_EQ(step.search->chosen->path.verdict, Reachability::Reachable);
    EXPECT_EQ(step.search->counts.poses_generated % 40, 0u);
  }
}

TEST(Tabletop, EveryObjectHasASegmentThatOutranksTableAndPanelAfterTheInitialScan) {
  const SimulatedRun& run = tabletop();
  const StepRecord& first = run.steps.at(0);
  const std::vector<int> objects = trueObjects(run, first);
  const std::vector<int> owner = segmentObjects(first, objects);
  ASSERT_EQ(run.truth->objectBoxes().size(), 5u);  // ball, two jugs, two boxes

  // The largest segments that are no object are the table and the panel.
  std::vector<const Segment*> others;
  std::map<int, double> best;
  for (const Segment& segment : first.saliency->segments) {
    if (owner[segment.label] < 0)
      others.push_back(&segment);
    else
      best[owner[segment.label]] = std::max(best[owner[segment.label]], segment.saliency);
  }
  ASSERT_GE(others.size(), 2u);
  std::sort(others.begin(), others.end(),
            [](const Segment* a, const Segment* b) { return a->points > b->points; });
  const double background = std::max(others[0]->saliency, others[1]->saliency);
  ASSERT_EQ(best.size(), 5u);
  for (const auto& [object, saliency] : best) EXPECT_GT(saliency, background) << "object " << object;
}

TEST(Tabletop, ObjectSegmentsWithMoreThanFiveContourPointsOutrankTableAndPanel) {
  const SimulatedRun& run = tabletop();
  const StepRecord& first = run.steps.at(0);
  const std::vector<int> owner = segmentObjects(first, trueObjects(run, first));
  double background = 0.0;
  std::uint32_t largest = 0, second = 0;
  for (const Segment& s : first.saliency->segments)
    if (owner[s.label] < 0) {
      if (s.points > largest)
        second = std::exchange(largest, s.points);
      else
        second = std::max(second, s.points);
    }
  for (const Segment& s : first.saliency->segments)
    if (owner[s.label] < 0 && s.points >= second) background = std::max(background, s.saliency);
  std::map<std::uint32_t, int> contour_points;
  for (const std::uint32_t label : *first.point_labels) ++contour_points[label];
  int tested = 0;
  for (const Segment& s : first.saliency->segments)
    if (owner[s.label] >= 0 && contour_points[s.label] > 5) {
      EXPECT_GT(s.saliency, background) << "segment " << s.label;
      ++tested;
    }
  EXPECT_GE(tested, 5);
}

TEST(Tabletop, AtLeast95PercentOfTheObjectPointsLieInObjectSegments) {
  const SimulatedRun& run = tabletop();
  const StepRecord& first = run.steps.at(0);
  const std::vector<int> objects = trueObjects(run, first);
  const std::vector<int> owner = segmentObjects(first, objects);
  int on_objects = 0, in_object_segments = 0;
  for (std::size_t n = 0; n < objects.size(); ++n) {
    if (objects[n] < 0) continue;
    ++on_objects;
    const std::uint32_t label = first.labels->of_point[n];
    in_object_segments += label > 0 && owner[label] >= 0;
  }
  ASSERT_GT(on_objects, 1000);
  RecordProperty("share", std::to_string(static_cast<double>(in_object_segments) / on_objects));
  EXPECT_GE(in_object_segments, 0.95 * on_objects);
}

TEST(Tabletop, AtLeastThreeViewsLookAtObjectsBeforeAnyLooksElsewhere) {
  int before_elsewhere = 0;
  for (const StepRecord& step : tabletop().steps) {
    ASSERT_TRUE(step.toward_object.has_value());
    if (!*step.toward_object) break;
    ++before_elsewhere;
  }
  EXPECT_GE(before_elsewhere, 3);
}

TEST(Tabletop, AtLeastFourViewsRealise30PercentOfTheirPredictedGain) {
  int kept = 0;
  for (const StepRecord& step : tabletop().steps) {
    ASSERT_TRUE(step.realised_voxels.has_value());
    ASSERT_GT(step.search->chosen->gain_voxels, 0u);
    kept += static_cast<double>(*step.realised_voxels) >=
            0.3 * static_cast<double>(step.search->chosen->gain_voxels);
  }
  EXPECT_GE(kept, 4);
}

TEST(Tabletop, UnknownNearTheObjectsFallsBy80Percent) {
  const SimulatedRun& run = tabletop();
  const auto before = run.steps.at(0).metrics.unknown_near_objects.value();
  const auto after = run.closing.metrics.unknown_near_objects.value();
  ASSERT_GT(before, 1000u);
  EXPECT_LE(static_cast<double>(after), 0.2 * static_cast<double>(before));
}

TEST(Tabletop, CoverageNeverFallsByMuchAndEndsAbove80Percent) {
  const SimulatedRun& run = tabletop();
  double last = 0.0;
  for (const StepRecord& step : run.steps) {
    EXPECT_GE(step.metrics.coverage.value(), last - 0.01);
    last = *step.metrics.coverage;
  }
  EXPECT_GE(run.closing.metrics.coverage.value(), 0.8);
}

TEST(Tabletop, OneThreadAndTwoThreadsGiveTheSameRun) {
  const SimulatedRun &one = tabletop(1), &two = tabletop(2);
  ASSERT_EQ(one.steps.size(), two.steps.size());
  for (std::size_t n = 0; n < one.steps.size(); ++n) {
    const StepRecord &a = one.steps[n], &b = two.steps[n];
    ASSERT_EQ(a.changed_bricks->size(), b.changed_bricks->size());
    for (std::size_t k = 0; k < a.changed_bricks->size(); ++k)
      ASSERT_EQ((*a.changed_bricks)[k].voxels, (*b.changed_bricks)[k].voxels);
    EXPECT_EQ(a.surface->points, b.surface->points);
    EXPECT_EQ(a.labels->of_point, b.labels->of_point);
    EXPECT_EQ(a.saliency->distance_to_other_m, b.saliency->distance_to_other_m);
    EXPECT_EQ(a.search->chosen->id, b.search->chosen->id);
    EXPECT_EQ(a.search->counts.rays, b.search->counts.rays);
    EXPECT_EQ(a.search->counts.voxels_visited, b.search->counts.voxels_visited);
    EXPECT_EQ(a.search->chosen->path.length_m, b.search->chosen->path.length_m);
    EXPECT_EQ(a.metrics.coverage, b.metrics.coverage);
  }
}

}  // namespace
}  // namespace vantage
