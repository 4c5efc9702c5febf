// The depth filters in the loop, behind a sensor with the faults of a Kinect V2.
#include <gtest/gtest.h>

#include "tests/support/simulated_run.h"

namespace vantage {
namespace {

using testing::exploreScene;
using testing::sceneSettings;
using testing::SimulatedRun;

const std::vector<std::string> kFaults = {"exploration.steps=1", "camera.faults=true"};
const std::vector<std::string> kFilters = {"exploration.steps=1", "camera.faults=true",
                                           "filter.bilateral=true", "filter.shadow=true", "filter.veil=true"};

/// Points of the fused surface above the table that lie farther than 3 cm from every object.
std::size_t strayPoints(const StepRecord& record, const SceneTruth& truth, const Box& workspace) {
  std::size_t count = 0;
  for (const Eigen::Vector3f& point : record.surface->points) {
    const Eigen::Vector3d p = point.cast<double>();
    count += workspace.contains(p) && p.z() > 0.03 && truth.objectDistance(p) > 0.03;
  }
  return count;
}

TEST(FilteredLoop, RemovesWhatTheSensorGetsWrongBeforeItIsFused) {
  const Settings faulty = sceneSettings("box", kFaults), filtered = sceneSettings("box", kFilters);
  const SimulatedRun raw = exploreScene("box", faulty), clean = exploreScene("box", filtered);
  ASSERT_FALSE(raw.steps.empty());
  ASSERT_FALSE(clean.steps.empty());
  const Box& workspace = faulty.exploration.workspace;
  const std::size_t before = strayPoints(raw.steps.front(), *raw.truth, workspace);
  const std::size_t after = strayPoints(clean.steps.front(), *clean.truth, workspace);
  EXPECT_GT(before, 30u) << "the faults must reach the map for the test to mean anything";
  EXPECT_LT(after, before / 4);
}

TEST(FilteredLoop, RecordsTheMaskOfTheLastFrameAndTheTime) {
  const SimulatedRun run = exploreScene("box", sceneSettings("box", kFilters));
  ASSERT_FALSE(run.steps.empty());
  for (const StepRecord& step : run.steps) {
    ASSERT_TRUE(step.filtered);
    EXPECT_EQ(step.filtered->mask.size(), step.depth->depth.depth_m.size());
    const MaskCounts counts = countMask(step.filtered->mask);
    EXPECT_GT(counts.shadow + counts.both, 0u);
    EXPECT_GT(counts.veil + counts.both, 0u);
    EXPECT_TRUE(step.timings.filter);
    for (std::size_t i = 0; i < step.filtered->mask.size(); ++i)
      ASSERT_EQ(step.filtered->mask[i] == 0, DepthImage::valid(step.filtered->depth.depth_m[i]));
  }
  EXPECT_TRUE(run.closing.filtered);
}

TEST(FilteredLoop, WithoutFiltersNothingIsRecorded) {
  const SimulatedRun run = exploreScene("box", sceneSettings("box", {"exploration.steps=1"}));
  ASSERT_FALSE(run.steps.empty());
  EXPECT_FALSE(run.steps.front().filtered);
  EXPECT_FALSE(run.steps.front().timings.filter);
}

}  // namespace
}  // namespace vantage
