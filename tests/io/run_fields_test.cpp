// The lists of fields that store a run name every field: a struct that grows must grow there too.

#include "io/run_fields.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

// The number of names of a structured binding must be the number of fields, or this does not compile. Then
// list the new field in io/run_fields.h, raise kRunVersion, and raise the number here.
#define EXPECT_FIELDS(Type, ...)                         \
  {                                                      \
    [[maybe_unused]] const auto& [__VA_ARGS__] = Type{}; \
    SUCCEED() << #Type;                                  \
  }

TEST(RunFields, NameEveryFieldOfEveryType) {
  EXPECT_FIELDS(PinholeCamera, a, b, c, d, e, f, g, h)
  EXPECT_FIELDS(GridGeometry, a, b, c)
  EXPECT_FIELDS(Sphere, a, b)
  EXPECT_FIELDS(TriangleMesh, a, b, c)
  EXPECT_FIELDS(DepthImage, a, b, c)
  EXPECT_FIELDS(ContourConfig, a, b, c, d, e, f)
  EXPECT_FIELDS(ContourViewConfig, a, b, c)
  EXPECT_FIELDS(SegmentationConfig, a, b, c, d, e, f, g, h, i, j)
  EXPECT_FIELDS(SaliencyConfig, a, b, c, d, e)
  EXPECT_FIELDS(GainConfig, a, b, c, d, e, f, g, h, i, j, k)
  EXPECT_FIELDS(ContourOptions, a, b)
  EXPECT_FIELDS(ContourPlannerConfig, a, b, c, d, e, f)
  EXPECT_FIELDS(FreeFlyerConfig, a, b, c, d, e, f, g, h, i, j)
  EXPECT_FIELDS(RunEnd, a, b, c)
  EXPECT_FIELDS(RunHeader, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s)
  EXPECT_FIELDS(OctreeHeader, a, b, c)
  EXPECT_FIELDS(BoxMetrics, a, b)
  EXPECT_FIELDS(ScanPose, a, b)
  EXPECT_FIELDS(DepthFrame, a, b, c)
  EXPECT_FIELDS(MapMetrics, a, b, c, d)
  EXPECT_FIELDS(Timings, a, b, c, d, e, f, g, h, i, j, k, l)
  EXPECT_FIELDS(StepRecord, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y)
  EXPECT_FIELDS(FilteredDepth, a, b)
  EXPECT_FIELDS(Realised, a, b, c)
  EXPECT_FIELDS(ContourVoxel, a, b, c, d)
  EXPECT_FIELDS(ContourPoint, a, b, c)
  EXPECT_FIELDS(Contours, a, b)
  EXPECT_FIELDS(SurfaceCloud, a, b, c)
  EXPECT_FIELDS(Labels, a, b, c)
  EXPECT_FIELDS(Segment, a, b, c, d, e, f, g, h, i, j)
  EXPECT_FIELDS(Saliency, a, b)
  EXPECT_FIELDS(ViewPosition, a, b, c)
  EXPECT_FIELDS(PoseScore, a, b, c, d, e, f, g)
  EXPECT_FIELDS(SegmentSearch, a, b, c, d, e, f, g, h)
  EXPECT_FIELDS(SearchCounts, a, b, c, d, e, f, g, h)
  EXPECT_FIELDS(MotionPlan, a, b, c, d, e, f, g)  // trajectory: StepRecord; by_orientation: not kept
  EXPECT_FIELDS(JointTrajectory, a, b, c)
  EXPECT_FIELDS(ArmJoint, a, b, c, d, e, f, g)
  EXPECT_FIELDS(LinkShape, a, b, c, d, e, f, g)
  EXPECT_FIELDS(RobotModel, a, b, c, d, e)
  EXPECT_FIELDS(ArmHeader, a, b, c)
  EXPECT_FIELDS(ChosenView, a, b, c, d, e)

  EXPECT_FIELDS(RaySensor, a, b, c, d, e)
  EXPECT_FIELDS(HierarchicalPlannerConfig, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q)
  EXPECT_FIELDS(OccupancyConfig, a, b, c, d, e, f, g, h)
  EXPECT_FIELDS(OctreeMapConfig, a, b, c, d, e)
  EXPECT_FIELDS(RayCounts, a, b, c, d, e, f, g, h, i, j)
  EXPECT_FIELDS(ViewUtility, a, b, c, d, e, f, g, h, i, j, k)
  EXPECT_FIELDS(UtilitySearch, a, b, c, d, e, f, g, h, i, j, k, l, m)
  EXPECT_FIELDS(ViewSearch, a, b, c, d, e)
}

}  // namespace
}  // namespace vantage
