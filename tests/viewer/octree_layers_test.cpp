#include <gtest/gtest.h>
#include <vtkActor.h>
#include <vtkMapper.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "core/gpu/egl_context.h"
#include "io/error.h"
#include "tests/support/synthetic_record.h"
#include "viewer/layers/layer.h"
#include "viewer/offscreen_renderer.h"
#include "viewer/scene.h"
#include "viewer/view_trace.h"

namespace vantage {
namespace {

using test::SyntheticOctreeRun;

const SyntheticOctreeRun& sharedRun() {
  static const SyntheticOctreeRun run = test::makeSyntheticOctreeRun();
  return run;
}

vtkPolyData* dataOf(const LayerContent& content, std::size_t index = 0) {
  if (index >= content.props.size()) return nullptr;
  vtkActor* actor = vtkActor::SafeDownCast(content.props[index]);
  return actor ? vtkPolyData::SafeDownCast(actor->GetMapper()->GetInput()) : nullptr;
}

bool hasMark(const LayerContent& content, LegendEntry::Mark mark) {
  return std::ranges::any_of(content.legend, [&](const LegendEntry& entry) { return entry.mark == mark; });
}

int countColor(const RgbImage& image, Rgb wanted, int tolerance) {
  int count = 0;
  const auto target = wanted.bytes();
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto pixel = image.at(x, y);
      int worst = 0;
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(pixel[c] - target[c]));
      count += worst <= tolerance;
    }
  }
  return count;
}

TEST(OctreeLayers, SyntheticStepHasEveryKindOfCandidate) {
  const UtilitySearch& search = *sharedRun().record.utilities;
  EXPECT_EQ(search.views.size(), 320u);
  EXPECT_GT(search.rejected_position, 0u);
  EXPECT_GT(search.rejected_registration, 0u);
  EXPECT_EQ(search.counts.poses_unreachable, 2u);
  ASSERT_TRUE(search.chosen);
}

TEST(OctreeLayers, EachOfAnOctreeStepIsDrawnWithALegend) {
  for (const Layer layer :
       {Layer::Workspace, Layer::ObjectBox, Layer::Occupied, Layer::Unknown, Layer::Octree,
        Layer::UtilitySphere, Layer::HitVoxels, Layer::CoarseRays, Layer::RefinedRays, Layer::RankedViews,
        Layer::ChosenView, Layer::Path, Layer::Candidates}) {
    const LayerContent content = buildLayer(layer, sharedRun().frame(), {});
    EXPECT_FALSE(content.props.empty()) << layerName(layer);
    EXPECT_FALSE(content.legend.empty()) << layerName(layer);
    for (const LegendEntry& entry : content.legend) EXPECT_FALSE(entry.text.empty()) << layerName(layer);
  }
}

TEST(OctreeLayers, ContourStepAndEmptyRecordHaveNone) {
  const test::SyntheticRun contour = test::makeEmptyRun();
  SyntheticOctreeRun bare = test::makeSyntheticOctreeRun();
  bare.record.utilities.reset();
  for (const Layer layer : {Layer::UtilitySphere, Layer::HitVoxels, Layer::CoarseRays, Layer::RefinedRays}) {
    EXPECT_TRUE(buildLayer(layer, contour.frame(), {}).props.empty()) << layerName(layer);
    EXPECT_TRUE(buildLayer(layer, bare.frame(), {}).props.empty()) << layerName(layer);
  }
  EXPECT_TRUE(buildLayer(Layer::Octree, contour.frame(), {}).props.empty());
  EXPECT_TRUE(buildLayer(Layer::ObjectBox, contour.frame(), {}).props.empty());
}

TEST(OctreeLayers, OneOccupiedVoxelMakesItsWholeNodeACube) {
  SyntheticOctreeRun run = test::makeSyntheticOctreeRun();
  const GridGeometry geometry = run.octree.geometry();
  StateGrid finest(geometry);
  std::ranges::fill(finest.editStates(), static_cast<std::uint8_t>(VoxelState::Free));
  const Eigen::Vector3d inside(0.015, 0.025, 0.205);
  finest.set(geometry.voxelAt(inside), VoxelState::Occupied);
  finest.rebuildFreeRadius();
  run.pyramid = StatePyramid(std::move(finest), firstVoxelOf(geometry), 4);
  for (const int level : {1, 2, 3}) {
    LayerStyle style;
    style.octree_level = level;
    const LayerContent content = buildLayer(Layer::Octree, run.frame(), style);
    ASSERT_EQ(content.props.size(), 3u) << level;  // voxel, node, edges of the node
    EXPECT_EQ(dataOf(content, 0)->GetNumberOfCells(), 6);
    EXPECT_EQ(dataOf(content, 1)->GetNumberOfCells(), 6);
    EXPECT_EQ(dataOf(content, 2)->GetNumberOfCells(), 12);
    double b[6];
    dataOf(content, 1)->GetBounds(b);
    const double edge_m = 0.01 * (1 << level);
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(b[2 * a + 1] - b[2 * a], edge_m, 1e-5);
      EXPECT_LT(b[2 * a], inside[a]);
      EXPECT_GT(b[2 * a + 1], inside[a]);
    }
  }
}

TEST(OctreeLayers, NodesInTheBoxAreThoseThatIntersectIt) {
  const SceneFrame frame = sharedRun().frame();
  const Box& object = frame.header.octree->object_box;
  for (const int level : {0, 1, 3, 6, 8}) {
    const GridGeometry& nodes = frame.pyramid->level(level).geometry();
    const Box in_box = nodesInBox(frame, level);
    std::size_t counted = 0, intersecting = 0;
    for (std::size_t n = 0; n < nodes.count(); ++n) {
      const Eigen::Vector3d center = nodes.center(nodes.voxel(n));
      const Eigen::Array3d apart = (center - object.center()).array().abs() - object.sizes().array() / 2;
      counted += in_box.contains(center);
      intersecting += level == 0 ? object.contains(center) : (apart < nodes.voxel_size_m / 2 - 1e-7).all();
    }
    EXPECT_GT(counted, 0u) << level;
    EXPECT_EQ(counted, intersecting) << level;
  }
}

TEST(OctreeLayers, AtACoarseLevelTheColourOfTheBoxStaysInItAndAllOfItMustBeSeen) {
  LayerStyle style;
  style.octree_level = 5;
  const SceneFrame frame = sharedRun().frame();
  const LayerContent content = buildLayer(Layer::Octree, frame, style);
  const Box& object = frame.header.octree->object_box;
  Box seen;
  for (const Eigen::Vector3d& point : content.must_see) seen.extend(point);
  EXPECT_TRUE(seen.contains(object));
  int in_box = 0;
  for (std::size_t i = 0; i < content.props.size(); ++i) {
    vtkActor* actor = vtkActor::SafeDownCast(content.props[i]);
    const double* color = actor->GetProperty()->GetColor();
    if (std::abs(color[0] - palette::kOccupied.r) > 1e-6) continue;
    ++in_box;
    double b[6];
    dataOf(content, i)->GetCellsBounds(b);
    for (int a = 0; a < 3; ++a) {
      EXPECT_GE(b[2 * a], object.min()[a] - 0.0151) << a;
      EXPECT_LE(b[2 * a + 1], object.max()[a] + 0.0151) << a;
    }
  }
  EXPECT_EQ(in_box, 1);
  EXPECT_TRUE(hasMark(content, LegendEntry::Mark::Line));  // nodes are no second grey
}

TEST(OctreeLayers, UnknownStaysTranslucent) {
  const LayerContent content = buildLayer(Layer::HitVoxels, sharedRun().frame(), {});
  int translucent = 0;
  for (std::size_t i = 0; i < content.props.size(); ++i) {
    vtkActor* actor = vtkActor::SafeDownCast(content.props[i]);
    const double* color = actor->GetProperty()->GetColor();
    if (std::abs(color[0] - palette::kUnknown.r) > 1e-6 || std::abs(color[1] - palette::kUnknown.g) > 1e-6)
      continue;
    EXPECT_LE(actor->GetProperty()->GetOpacity(), 0.15);
    ++translucent;
  }
  EXPECT_GT(translucent, 0);
}

TEST(ViewTrace, CountsAreThoseThatThePlannerRecorded) {
  const UtilitySearch& search = *sharedRun().record.utilities;
  int compared = 0;
  for (std::size_t i = 0; i < search.views.size(); i += 7) {
    if (search.views[i].rejection == ViewRejection::Position) continue;
    LayerStyle style;
    style.view_id = static_cast<int>(search.views[i].id);
    const auto trace = traceView(sharedRun().frame(), style);
    ASSERT_TRUE(trace);
    EXPECT_EQ(trace->counts.unknown, search.views[i].rays.unknown) << i;
    EXPECT_EQ(trace->counts.occupied, search.views[i].rays.occupied) << i;
    EXPECT_EQ(trace->counts.rays_cast, search.views[i].rays.rays_cast) << i;
    EXPECT_EQ(trace->rays.size(), trace->counts.rays_cast) << i;
    ++compared;
  }
  EXPECT_GT(compared, 10);
}

TEST(ViewTrace, ChosenViewIsTheDefaultThenTheBestThenNone) {
  SyntheticOctreeRun run = test::makeSyntheticOctreeRun();
  EXPECT_EQ(tracedView(run.frame(), {})->id, run.record.utilities->chosen->id);
  UtilitySearch search = *run.record.utilities;
  search.chosen.reset();
  run.record.utilities = std::make_shared<UtilitySearch>(search);
  EXPECT_EQ(tracedView(run.frame(), {}), &run.record.utilities->views[search.ranking.front()]);
  search.ranking.clear();
  run.record.utilities = std::make_shared<UtilitySearch>(search);
  EXPECT_EQ(tracedView(run.frame(), {}), nullptr);
  LayerStyle style;
  style.view_id = 320;
  EXPECT_THROW(tracedView(run.frame(), style), InputError);
  EXPECT_THROW(buildLayer(Layer::CoarseRays, run.frame(), style), InputError);
}

TEST(ViewTrace, ThinningKeepsFamiliesTogether) {
  const auto trace = traceView(sharedRun().frame(), {});
  ASSERT_TRUE(trace);
  const RayTree& tree = sharedRun().tree;
  for (const int most : {1, 50, 300, 1'000'000}) {
    const DrawnRays drawn = thinned(*trace, tree, most);
    EXPECT_LE(drawn.coarse.size(), static_cast<std::size_t>(most) + 60) << most;  // whole rows and columns
    std::set<std::uint32_t> refined;
    for (const std::size_t index : drawn.coarse)
      if (trace->rays[index].fate == RayFate::Refined) refined.insert(trace->rays[index].ray);
    for (const std::size_t index : drawn.refined) {
      const TracedRay& ray = trace->rays[index];
      if (ray.level + 1 != trace->coarse_levels) continue;
      const RayLevel &fine = tree.level(ray.level), &coarse = tree.level(ray.level + 1);
      EXPECT_TRUE(refined.contains(coarse.index(fine.rows.parent[ray.ray / fine.columns.count()],
                                                fine.columns.parent[ray.ray % fine.columns.count()])));
    }
  }
  const DrawnRays all = thinned(*trace, tree, 1'000'000);
  EXPECT_EQ(all.coarse.size() + all.refined.size(), trace->rays.size());
}

TEST(ViewTrace, NodesHitAreOfTheStateOfTheirFate) {
  const auto trace = traceView(sharedRun().frame(), {});
  ASSERT_TRUE(trace);
  const StatePyramid& pyramid = sharedRun().pyramid;
  std::size_t unknown = 0, occupied = 0;
  for (int level = 0; level <= trace->coarse_levels; ++level) {
    for (const std::size_t node : nodesHit(*trace, pyramid, level, RayFate::Unknown)) {
      EXPECT_EQ(pyramid.level(level).at(pyramid.level(level).geometry().voxel(node)), VoxelState::Unknown);
      ++unknown;
    }
    for (const std::size_t node : nodesHit(*trace, pyramid, level, RayFate::Occupied)) {
      EXPECT_EQ(level, 0);
      EXPECT_EQ(pyramid.finest().at(pyramid.finest().geometry().voxel(node)), VoxelState::Occupied);
      ++occupied;
    }
  }
  EXPECT_GT(unknown, 5u);
  EXPECT_GT(occupied, 20u);
}

/// The run with one survivor, which was not tried, as near a view taken before.
SyntheticOctreeRun runWithATakenView(CandidateGenerator generator = CandidateGenerator::Icosphere) {
  SyntheticOctreeRun run = test::makeSyntheticOctreeRun(generator);
  UtilitySearch search = *run.record.utilities;
  ViewUtility& view = search.views.at(search.ranking.back());
  view.rejection = ViewRejection::Executed;
  view.unknown = view.occupied = view.surface = view.distance = view.utility = 0.0;
  search.ranking.pop_back();
  search.counts.poses_executed_before = 1;
  run.record.utilities = std::make_shared<UtilitySearch>(search);
  return run;
}

TEST(UtilitySphere, HasOneFaceACandidateAndAMarkForEveryReason) {
  const SyntheticOctreeRun run = runWithATakenView();
  const LayerContent content = buildLayer(Layer::UtilitySphere, run.frame(), {});
  ASSERT_NE(dataOf(content), nullptr);
  EXPECT_EQ(dataOf(content)->GetNumberOfCells(), 320);
  EXPECT_TRUE(hasMark(content, LegendEntry::Mark::Crossed));
  EXPECT_TRUE(hasMark(content, LegendEntry::Mark::Striped));
  EXPECT_TRUE(hasMark(content, LegendEntry::Mark::Diamond));
  EXPECT_TRUE(hasMark(content, LegendEntry::Mark::Ringed));
  // A mark more than without the view that was taken: its ring.
  const LayerContent before = buildLayer(Layer::UtilitySphere, sharedRun().frame(), {});
  EXPECT_FALSE(hasMark(before, LegendEntry::Mark::Ringed));
  EXPECT_EQ(dataOf(content, 2)->GetNumberOfCells(), dataOf(before, 2)->GetNumberOfCells() + 2 * 10);
  EXPECT_EQ(dataOf(content, 1)->GetNumberOfCells(), dataOf(before, 1)->GetNumberOfCells() - 1);
  std::set<std::array<std::uint8_t, 3>> neutral;
  for (const LegendEntry& entry : content.legend) neutral.insert(entry.color.bytes());
  EXPECT_EQ(neutral.size(), content.legend.size());  // no two reasons share a colour
}

TEST(UtilitySphere, EveryFactorHasAScaleWithItsUnit) {
  std::set<std::string> titles;
  for (const std::string_view name : factorNames()) {
    LayerStyle style;
    style.utility_factor = *factorNamed(name);
    const LayerContent content = buildLayer(Layer::UtilitySphere, sharedRun().frame(), style);
    ASSERT_TRUE(content.scale) << name;
    EXPECT_GT(content.scale->high, 0.0) << name;
    titles.insert(content.scale->title);
    const bool counts = name == "unknown" || name == "occupied";
    EXPECT_EQ(content.scale->title.find("rays") != std::string::npos, counts) << name;
  }
  EXPECT_EQ(titles.size(), 4u);
}

TEST(UtilitySphere, WorkspaceCandidatesAreDotsAndMarks) {
  const SyntheticOctreeRun run = test::makeSyntheticOctreeRun(CandidateGenerator::Workspace);
  ASSERT_FALSE(run.record.utilities->ranking.empty());
  const LayerContent content = buildLayer(Layer::UtilitySphere, run.frame(), {});
  ASSERT_NE(dataOf(content), nullptr);
  std::size_t left = 0;
  for (const std::uint32_t index : run.record.utilities->ranking)
    left += !isUnreachable(run.record.utilities->views[index].reachability);
  ASSERT_GE(content.props.size(), 3u);  // frusta of the best, the chosen one, dots
  EXPECT_EQ(static_cast<std::size_t>(dataOf(content, 0)->GetNumberOfCells()),
            8 * std::min<std::size_t>(left, 24));
  EXPECT_EQ(static_cast<std::size_t>(dataOf(content, 2)->GetNumberOfCells()), left);
  EXPECT_TRUE(hasMark(content, LegendEntry::Mark::Cross));
  const SyntheticOctreeRun taken = runWithATakenView(CandidateGenerator::Workspace);
  EXPECT_TRUE(hasMark(buildLayer(Layer::UtilitySphere, taken.frame(), {}), LegendEntry::Mark::Ringed));
}

TEST(LayerStyle, NewSettingsOutOfRangeAreRefused) {
  LayerStyle style;
  style.octree_level = 9;
  EXPECT_THROW(style.validate(), std::invalid_argument);
  style = {};
  style.view_id = -1;
  EXPECT_THROW(style.validate(), std::invalid_argument);
  style = {};
  style.coarse_rays = 0;
  EXPECT_THROW(style.validate(), std::invalid_argument);
}

class OctreeScene : public testing::Test {
 protected:
  static void SetUpTestSuite() { unsetenv("DISPLAY"); }
  RgbImage draw(const SceneFrame& frame, const ViewSettings& view) {
    Scene scene;
    scene.setFrame(frame);
    scene.show(view, {"Title", "run", "figures"}, PageStyle::ViewOnly, 640, 400);
    return renderer_.render(scene.renderers(), 640, 400);
  }
  EglContext context_;
  OffscreenRenderer renderer_{context_};
};

TEST_F(OctreeScene, RaysAndTheirFatesAreInThePicture) {
  ViewSettings view;
  view.layers = {Layer::CoarseRays, Layer::RefinedRays, Layer::HitVoxels};
  const RgbImage image = draw(sharedRun().frame(), view);
  EXPECT_GT(countColor(image, palette::kUnknown, 40), 50);
  EXPECT_GT(countColor(image, palette::kRayOccupied, 50), 20);
  EXPECT_GT(countColor(image, palette::kRayRefined, 50), 20);
}

TEST_F(OctreeScene, ChosenFaceIsOutlinedAndFacesHaveTheColoursOfTheScale) {
  ViewSettings view;
  view.layers = {Layer::UtilitySphere};
  const RgbImage image = draw(sharedRun().frame(), view);
  EXPECT_GT(countColor(image, palette::kChosen, 60), 40);
  EXPECT_GT(countColor(image, palette::kRejectedPosition, 4), 200);
  const UtilitySearch& search = *sharedRun().record.utilities;
  const LayerContent content = buildLayer(Layer::UtilitySphere, sharedRun().frame(), {});
  int seen = 0;
  for (const std::uint32_t index : search.ranking)
    seen += countColor(image, colorAt(ColorMap::Viridis, search.views[index].utility / content.scale->high),
                       2) > 0;
  EXPECT_GT(seen, static_cast<int>(search.ranking.size()) / 2);
}

TEST_F(OctreeScene, AllLayersDrawTwiceTheSame) {
  ViewSettings view;
  for (int i = 0; i < kLayerCount; ++i) view.layers.set(static_cast<Layer>(i), true);
  EXPECT_EQ(draw(sharedRun().frame(), view), draw(sharedRun().frame(), view));
}

}  // namespace
}  // namespace vantage
