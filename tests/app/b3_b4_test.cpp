// B4's geometry against what it gives in closed form and by an independent computation; B3's planes.
#include <gtest/gtest.h>

#include <numbers>

#include "viewer/app/experiments/b3_planes.h"
#include "viewer/app/experiments/b4_bar.h"
#include "viewer/app/experiments/experiments.h"

namespace vantage::experiments {
namespace {

TEST(B4, PixelsOfTheNarrowBarEqualTheIndependentComputation) {  // evaluation.md, section 5
  const struct {
    double degrees;
    std::uint64_t removed, shadowed;
  } expected[] = {{-60, 6372, 6140}, {-30, 5333, 5575}, {0, 5630, 5195}, {30, 5883, 5897}, {60, 6556, 6054}};
  for (const auto& e : expected) {
    BarScene scene;
    scene.width_m = 0.04;
    scene.angle_rad = e.degrees * std::numbers::pi / 180;
    const BarResult result = measureBar(scene);
    EXPECT_NEAR(static_cast<double>(result.removed), static_cast<double>(e.removed), 0.01 * e.removed)
        << e.degrees;
    EXPECT_NEAR(static_cast<double>(result.shadowed), static_cast<double>(e.shadowed), 0.01 * e.shadowed)
        << e.degrees;
  }
}

TEST(B4, EveryCriterionPasses) {
  ExperimentOptions options;
  options.quick = true;
  const Report report = runB4(options);
  ASSERT_EQ(report.claims.size(), 4u);
  for (const Claim& claim : report.claims)
    EXPECT_EQ(claim.verdict, Verdict::Pass) << claim.experiment << ": " << claim.ours;
  EXPECT_TRUE(report.not_run.empty());
}

TEST(B4, AThinPlateMeetsTheClosedForm) {
  EXPECT_NEAR(plateFdr(0.04, 1.0, 2.5, 0.08), 0.1667, 1e-4);
  EXPECT_DOUBLE_EQ(plateFdr(0.048, 1.0, 2.5, 0.08), 0.0);
  EXPECT_DOUBLE_EQ(plateFdr(0.10, 1.0, 2.5, 0.08), 0.0);
}

TEST(B3, TheThreeFiltersLeaveFarFewerOutliersThanTheBilateralAlone) {
  const PlanesScene scene({});
  const DepthImage mean = scene.meanDepth(3, {});
  DepthFilterConfig config = scene.filters();
  config.bilateral = true;
  const FilteredDepth smooth = scene.filtered(mean, config);
  config.shadow = config.veil = true;
  const PlanesResult before = scene.measure(smooth, smooth),
                     after = scene.measure(smooth, scene.filtered(mean, config));
  EXPECT_GT(before.valid, 40000u);
  EXPECT_GT(before.outliers, 200u) << "the faults must be there";
  EXPECT_EQ(before.lost, 0u);
  EXPECT_LT(after.outliers, before.outliers / 4);
  EXPECT_GT(after.removed.shadow, 0u);
  EXPECT_GT(after.removed.veil, 0u);
  EXPECT_LT(after.valid, before.valid);
}

TEST(B3, TheMeanDependsOnTheSeedAndNothingElse) {
  const PlanesScene scene({});
  const DepthImage a = scene.meanDepth(1, {}), b = scene.meanDepth(1, {}), c = scene.meanDepth(2, {});
  std::size_t same = 0, other = 0;
  for (std::size_t i = 0; i < a.depth_m.size(); ++i) {
    if (!DepthImage::valid(a.depth_m[i])) continue;
    same += a.depth_m[i] == b.depth_m[i];
    other += a.depth_m[i] != c.depth_m[i];
    ASSERT_EQ(a.depth_m[i], b.depth_m[i]);
  }
  EXPECT_GT(other, same / 2);
}

}  // namespace
}  // namespace vantage::experiments
