#include "viewer/view_hits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkActor.h>
#include <vtkDataArray.h>
#include <vtkMapper.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>

#include "core/raycasting/uniform_caster.h"
#include "io/error.h"
#include "tests/support/synthetic_record.h"
#include "viewer/layers/layer.h"
#include "viewer/layers/prop_look.h"

namespace vantage {
namespace {

using test::SyntheticRun;
using testing::HasSubstr;

const SyntheticRun& sharedRun() {
  static const SyntheticRun run = test::makeSyntheticRun();
  return run;
}

LayerStyle ofView(std::uint32_t id) {
  LayerStyle style;
  style.view_id = static_cast<int>(id);
  return style;
}

TEST(ViewHits, CountTheRaysOfEveryScore) {
  const SyntheticRun& run = sharedRun();
  int checked = 0;
  for (const SegmentSearch& search : run.record.search->segments) {
    for (std::size_t n = 0; n < search.scores.size(); n += 29) {
      const PoseScore& score = search.scores[n];
      const auto hits = castView(run.frame(), ofView(score.id));
      ASSERT_TRUE(hits);
      EXPECT_EQ(hits->view, score.id);
      EXPECT_EQ(hits->counted.rays, score.unknown) << score.id;
      EXPECT_EQ(hits->known.rays, score.occupied) << score.id;
      ++checked;
    }
  }
  EXPECT_GT(checked, 20);
}

TEST(ViewHits, VoxelsAreThoseThatTheCasterTellsApart) {
  const SyntheticRun& run = sharedRun();
  const auto hits = castView(run.frame(), {});
  ASSERT_TRUE(hits);
  EXPECT_EQ(hits->view, run.record.chosen()->id) << "the chosen view unless another is asked for";
  VisibilityQuery query;
  query.sphere = hits->region;
  query.distinct_voxels = true;
  const PinholeCamera camera = run.header.camera.reduced(run.header.contour_config.gain.reduction);
  const VisibilityCounts counts = castUniform(run.states, camera, hits->T_world_camera, query);
  ASSERT_GT(counts.unknown_voxels, 10u);
  EXPECT_EQ(hits->counted.voxels.size(), counts.unknown_voxels);
  EXPECT_EQ(hits->known.voxels.size(), counts.occupied_voxels);
  EXPECT_EQ(hits->rays, counts.rays);
}

TEST(ViewHits, GroupsAreWhatTheirNamesSay) {
  const SyntheticRun& run = sharedRun();
  const auto hits = castView(run.frame(), {});
  ASSERT_TRUE(hits);
  const GridGeometry& grid = run.states.geometry();
  const auto all = [&](const RayGroup& group, VoxelState state, bool inside) {
    return std::ranges::all_of(group.voxels, [&](std::size_t index) {
      const Eigen::Vector3i voxel = grid.voxel(index);
      const double distance_m = (grid.center(voxel) - hits->region.center).norm();
      return run.states.at(voxel) == state && (distance_m <= hits->region.radius + 1e-6) == inside;
    });
  };
  EXPECT_TRUE(all(hits->counted, VoxelState::Unknown, true));
  EXPECT_TRUE(all(hits->known, VoxelState::Occupied, true));
  EXPECT_TRUE(all(hits->occluded, VoxelState::Occupied, false));
  EXPECT_TRUE(all(hits->unknown_before, VoxelState::Unknown, false));
  std::uint64_t rays = 0;
  for (const RayGroup* group :
       {&hits->counted, &hits->known, &hits->occluded, &hits->unknown_before, &hits->too_near}) {
    EXPECT_GE(group->rays, group->voxels.size());
    EXPECT_TRUE(std::ranges::is_sorted(group->voxels));
    rays += group->rays;
  }
  EXPECT_LE(rays, hits->rays);
}

TEST(ViewHits, RaysLeaveBallsAndBoxesWhereGeometrySays) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), far(-3.0, 0.0, 0.0);
  EXPECT_NEAR(leavesAt(Sphere{{0, 0, 0}, 1.0}, far, x), 4.0, 1e-12);
  EXPECT_NEAR(leavesAt(Sphere{{0, 0.6, 0}, 1.0}, far, x), 3.8, 1e-12);
  EXPECT_LT(leavesAt(Sphere{{0, 2, 0}, 1.0}, far, x), 0.0);
  EXPECT_LT(leavesAt(Sphere{{0, 0, 0}, 1.0}, far, -x), 0.0) << "behind the ray";
  const Box box(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(2, 1, 1));
  EXPECT_NEAR(leavesAt(box, far, x), 5.0, 1e-12);
  EXPECT_NEAR(leavesAt(box, Eigen::Vector3d::Zero(), x), 2.0, 1e-12);
  EXPECT_LT(leavesAt(box, far, Eigen::Vector3d::UnitY()), 0.0);
  EXPECT_LT(leavesAt(Box(), far, x), 0.0);
}

TEST(ViewHits, ViewsThatWereNeverScoredHaveThemToo) {
  SyntheticRun run = sharedRun();
  auto search = std::make_shared<ViewSearch>(*run.record.search);
  const std::uint32_t scored =
      search->segments.back().scores.empty() ? search->chosen->id : search->segments.back().scores.front().id;
  const auto before = castView(run.frame(), ofView(scored));
  for (SegmentSearch& segment : search->segments) {
    segment.scored = false;
    segment.scores.clear();
  }
  search->chosen.reset();
  run.record.search = search;
  EXPECT_FALSE(castView(run.frame(), {})) << "no view to show unless one is asked for";
  const auto hits = castView(run.frame(), ofView(scored));
  ASSERT_TRUE(hits);
  EXPECT_EQ(hits->counted.voxels, before->counted.voxels);
}

TEST(ViewHits, BaselineCountsInTheWorkspace) {
  SyntheticRun run = sharedRun();
  SegmentSearch all = run.record.search->segments.front();
  all.sphere = {};
  auto search = std::make_shared<ViewSearch>(*run.record.search);
  search->segments = {all};
  search->chosen->search = 0;
  search->chosen->id = all.scores.front().id;
  run.record.search = search;
  const auto hits = castView(run.frame(), {});
  ASSERT_TRUE(hits);
  for (const std::size_t index : hits->counted.voxels)
    EXPECT_TRUE(
        run.header.workspace.contains(run.states.geometry().center(run.states.geometry().voxel(index))));
  VisibilityQuery query;
  query.bounds = run.header.workspace;
  const PinholeCamera camera = run.header.camera.reduced(run.header.contour_config.gain.reduction);
  const VisibilityCounts counts = castUniform(run.states, camera, hits->T_world_camera, query);
  EXPECT_EQ(hits->counted.rays, counts.unknown);
  EXPECT_EQ(hits->known.rays, counts.occupied);
  EXPECT_GT(hits->known.rays, 0u);
}

TEST(ViewHits, UnknownViewsAreRefusedAndStepsWithoutViewsHaveNone) {
  EXPECT_THROW(castView(sharedRun().frame(), ofView(99'999'999)), InputError);
  EXPECT_FALSE(castView(test::makeEmptyRun().frame(), {}));
  EXPECT_FALSE(castView(test::makeSyntheticOctreeRun().frame(), {}));
}

TEST(ExplainLayers, NameTheirCounts) {
  const SyntheticRun& run = sharedRun();
  const auto hits = castView(run.frame(), {});
  const LayerContent lit = buildLayer(Layer::HitVoxels, run.frame(), {});
  ASSERT_FALSE(lit.props.empty());
  EXPECT_THAT(lit.legend.front().text, HasSubstr("view " + std::to_string(hits->view)));
  EXPECT_THAT(lit.legend.front().text, HasSubstr("voxels"));
  const LayerContent occluders = buildLayer(Layer::Occluders, run.frame(), {});
  ASSERT_FALSE(occluders.props.empty());
  for (const LegendEntry& entry : occluders.legend) EXPECT_EQ(entry.mark, LegendEntry::Mark::Striped);
}

TEST(ExplainLayers, LitVoxelsShineInEveryTheme) {
  LayerContent lit = buildLayer(Layer::HitVoxels, sharedRun().frame(), {});
  applyTheme(lit, {rgb(24, 26, 30), rgb(230, 232, 235)});
  int dots = 0;
  for (const auto& prop : lit.props) {
    auto* actor = vtkActor::SafeDownCast(prop);
    auto* data = actor ? vtkPolyData::SafeDownCast(actor->GetMapper()->GetInput()) : nullptr;
    if (!data || data->GetNumberOfVerts() == 0) continue;
    ++dots;
    vtkDataArray* colors = data->GetPointData()->GetScalars();
    ASSERT_TRUE(colors) << "a theme would change its colour";
    for (int c = 0; c < 3; ++c) EXPECT_EQ(colors->GetComponent(0, c), palette::kLit.bytes()[c]);
  }
  EXPECT_GT(dots, 0);
}

TEST(ExplainLayers, OctreeViewsHaveOccludersToo) {
  const test::SyntheticOctreeRun run = test::makeSyntheticOctreeRun();
  const LayerContent content = buildLayer(Layer::Occluders, run.frame(), {});
  ASSERT_FALSE(content.props.empty());
  EXPECT_EQ(content.legend.front().mark, LegendEntry::Mark::Striped);
}

}  // namespace
}  // namespace vantage
