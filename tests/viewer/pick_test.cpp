#include "viewer/pick.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "core/raycasting/uniform_caster.h"
#include "tests/support/synthetic_record.h"

namespace vantage {
namespace {

using test::SyntheticRun;

constexpr PictureSize kPicture{800, 500};

const SyntheticRun& sharedRun() {
  static const SyntheticRun run = test::makeSyntheticRun();
  return run;
}

ViewSettings showing(LayerSet layers) {
  ViewSettings settings;
  settings.layers = layers;
  return settings;
}

/// A grid of 20^3 free voxels of 5 cm from the origin with a wall of unknown at x >= 0.75 and one occupied
/// voxel.
struct SmallScene {
  RunHeader header;
  StepRecord record;
  StateGrid states{GridGeometry{{0.025, 0.025, 0.025}, 0.05, {20, 20, 20}}};
  const Eigen::Vector3i solid{10, 10, 10};

  SmallScene() {
    for (std::size_t v = 0; v < states.geometry().count(); ++v) {
      const Eigen::Vector3i voxel = states.geometry().voxel(v);
      states.set(voxel, voxel.x() >= 15 ? VoxelState::Unknown : VoxelState::Free);
    }
    states.set(solid, VoxelState::Occupied);
    header.workspace = states.geometry().bounds();
    header.volume = states.geometry();
  }
  SceneFrame frame() const { return {header, record, states}; }
};

TEST(PickVoxel, OccupiedVoxelsStopRaysFromOutsideTheGrid) {
  const SmallScene scene;
  const Eigen::Vector3d center = scene.states.geometry().center(scene.solid);
  for (const Eigen::Vector3d& from : {Eigen::Vector3d(-3, 0.4, 0.2), {0.5, -2, 0.5}, {0.4, 0.5, 7}}) {
    const EyeRay ray{from, (center - from).normalized()};
    const auto hit = pickVoxel(scene.frame(), showing({Layer::Occupied}), ray);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->voxel, scene.solid);
    EXPECT_EQ(hit->state, VoxelState::Occupied);
    const Eigen::Vector3d p = ray.origin + hit->distance_m * ray.direction;
    EXPECT_NEAR((p - center).cwiseAbs().maxCoeff(), 0.025, 1e-9) << "it is entered through its border";
    EXPECT_FALSE(pickVoxel(scene.frame(), showing({Layer::Path}), ray));
  }
  const EyeRay past{{-3, 0.9, 0.2}, Eigen::Vector3d::UnitY()};
  EXPECT_FALSE(pickVoxel(scene.frame(), showing({Layer::Occupied}), past));
}

TEST(PickVoxel, FrontierStopsRaysOnlyIfItIsShownAndFromItsFreeSide) {
  const SmallScene scene;
  const EyeRay ray{{-1.0, 0.33, 0.33}, Eigen::Vector3d::UnitX()};
  EXPECT_FALSE(pickVoxel(scene.frame(), showing({Layer::Occupied}), ray));
  const auto hit = pickVoxel(scene.frame(), showing({Layer::Unknown}), ray);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->voxel.x(), 15);
  EXPECT_EQ(hit->state, VoxelState::Unknown);
  EXPECT_NEAR(hit->distance_m, 1.75, 1e-9);
  const EyeRay behind{{3.0, 0.33, 0.33}, -Eigen::Vector3d::UnitX()};
  EXPECT_FALSE(pickVoxel(scene.frame(), showing({Layer::Unknown}), behind));
}

TEST(PickVoxel, ClipBoxAndWorkspaceAreObeyed) {
  SmallScene scene;
  const Eigen::Vector3d center = scene.states.geometry().center(scene.solid);
  const EyeRay ray{{-1.0, center.y(), center.z()}, Eigen::Vector3d::UnitX()};
  ViewSettings settings = showing({Layer::Occupied, Layer::Unknown});
  ASSERT_EQ(pickVoxel(scene.frame(), settings, ray)->voxel, scene.solid);
  settings.clip = Box(Eigen::Vector3d(0.6, 0, 0), Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(pickVoxel(scene.frame(), settings, ray)->state, VoxelState::Unknown);
  settings.clip = Box(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.4, 1, 1));
  EXPECT_FALSE(pickVoxel(scene.frame(), settings, ray));
  settings.clip.reset();
  scene.header.workspace.max().x() = 0.4;
  EXPECT_FALSE(pickVoxel(scene.frame(), settings, ray));
}

TEST(PickVoxel, SlicesShowVoxelsOfAnyStateWhereTheyStandBeforeOthers) {
  const SmallScene scene;
  ViewSettings settings = showing({Layer::Slices, Layer::Occupied});
  settings.style.slices = {SlicePlane{true, 0.26}, SlicePlane{}, SlicePlane{}};
  const Eigen::Vector3d center = scene.states.geometry().center(scene.solid);
  const EyeRay ray{{-1.0, center.y(), center.z()}, Eigen::Vector3d::UnitX()};
  const auto hit = pickVoxel(scene.frame(), settings, ray);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->voxel, Eigen::Vector3i(5, 10, 10));
  EXPECT_EQ(hit->state, VoxelState::Free);
  EXPECT_NEAR(hit->distance_m, 1.26, 1e-9);
  settings.style.slices[0].at_m = 0.9;
  EXPECT_EQ(pickVoxel(scene.frame(), settings, ray)->voxel, scene.solid);
}

TEST(PickVoxel, AgreesWithThePlannersRaysFromInsideTheGrid) {
  const SyntheticRun& run = sharedRun();
  SceneFrame frame = run.frame();
  RunHeader header = run.header;
  header.workspace = run.states.geometry().bounds();  // so that nothing is left out of the picture
  std::mt19937 random(11);
  std::normal_distribution<double> along;
  const GridGeometry& grid = run.states.geometry();
  int hits = 0;
  for (int n = 0; n < 1500; ++n) {
    Eigen::Vector3i start;
    do start = grid.voxel(random() % grid.count());
    while (run.states.at(start) != VoxelState::Free);
    const EyeRay ray{grid.center(start),
                     Eigen::Vector3d(along(random), along(random), along(random)).normalized()};
    const auto expected = castRay(run.states, ray.origin, ray.direction, 100.0);
    const auto found =
        pickVoxel({header, run.record, run.states}, showing({Layer::Occupied, Layer::Unknown}), ray);
    ASSERT_EQ(found.has_value(), expected.has_value()) << n;
    if (!found) continue;
    ++hits;
    EXPECT_NEAR(found->distance_m, expected->length_m, 1e-4);
    EXPECT_LE((found->voxel - expected->voxel).cwiseAbs().maxCoeff(), 1);
  }
  EXPECT_GT(hits, 200);
}

/// What is under a world point.
std::optional<Picked> under(const SyntheticRun& run, const ViewSettings& settings, const Eye& eye,
                            const Eigen::Vector3d& p, const Eigen::Vector2d& beside = {0, 0}) {
  Picker picker;
  return picker.at(run.frame(), settings, eye, *pixelOf(eye, p, kPicture) + beside, kPicture);
}

TEST(Picker, FindsFrustaByTheirApexes) {
  const SyntheticRun& run = sharedRun();
  const ChosenView& chosen = *run.record.chosen();
  const Eigen::Vector3d apex = chosen.T_world_camera.translation();
  Eye eye;
  eye.position = apex + Eigen::Vector3d(0.4, -1.5, 1.0);
  eye.focus = apex;
  const ViewSettings settings = showing({Layer::ChosenView, Layer::RankedViews, Layer::Segments});
  const auto picked = under(run, settings, eye, apex, {4.0, 3.0});
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->kind, PickedKind::Frustum);
  EXPECT_EQ(picked->id, chosen.id);
  EXPECT_EQ(picked->p_world, apex);
  EXPECT_NEAR(picked->distance_m, eye.distance(), 1e-9);
  const auto beside = under(run, showing({Layer::ChosenView}), eye, apex, {9.0, 9.0});
  EXPECT_FALSE(beside) << "farther than the radius";
  for (const RankedPosition& view : drawnViews(run.frame(), settings.style)) {
    eye.focus = view.T_world_camera.translation();
    eye.position = eye.focus + Eigen::Vector3d(0.0, -0.2, 0.1);
    const auto ranked = under(run, settings, eye, eye.focus);
    ASSERT_TRUE(ranked);
    EXPECT_EQ(ranked->kind, PickedKind::Frustum);
    EXPECT_LT((ranked->p_world - eye.focus).norm(), 1e-9);
  }
}

TEST(Picker, FindsFrustaAlongTheirLines) {
  const SyntheticRun& run = sharedRun();
  const ChosenView& chosen = *run.record.chosen();
  const FrustumCorners corners =
      frustumCorners(viewCamera(run.frame()), chosen.T_world_camera, chosenFrustumLength(run.frame()));
  Eye eye;
  eye.position = corners.apex + Eigen::Vector3d(0.4, -1.5, 1.0);
  eye.focus = corners.apex;
  const ViewSettings settings = showing({Layer::ChosenView});
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d beside = 0.5 * (corners.apex + corners.image[i]),
                          far_side = 0.3 * corners.image[i] + 0.7 * corners.image[(i + 1) % 4];
    for (const Eigen::Vector3d& on_line : {beside, far_side}) {
      const auto picked = under(run, settings, eye, on_line, {1.5, -1.0});
      ASSERT_TRUE(picked) << i;
      EXPECT_EQ(picked->id, chosen.id);
      EXPECT_EQ(picked->p_world, corners.apex);
    }
  }
  const Eigen::Vector3d inside =
      0.25 * (corners.image[0] + corners.image[1] + corners.image[2] + corners.image[3]);
  EXPECT_FALSE(under(run, settings, eye, inside)) << "between its lines there is nothing";
}

TEST(Picker, WhatStandsBeforeAFrustumHidesIt) {
  SmallScene scene;
  scene.record.positions = std::make_shared<std::vector<ViewPosition>>(1);
  auto positions = std::make_shared<std::vector<ViewPosition>>(1);
  (*positions)[0].first_id = 0;
  const Eigen::Vector3d center = scene.states.geometry().center(scene.solid);
  (*positions)[0].T_world_camera.translation() = center + Eigen::Vector3d(0.2, 0, 0);
  scene.record.positions = positions;
  Eye eye;
  eye.position = center - Eigen::Vector3d(2, 0, 0);
  eye.focus = center;
  Picker picker;
  const auto at = [&](LayerSet layers) {
    return picker.at(scene.frame(), showing(layers), eye, {400, 250}, kPicture);
  };
  ASSERT_TRUE(at({Layer::Candidates}));
  EXPECT_EQ(at({Layer::Candidates})->kind, PickedKind::Frustum);
  ASSERT_TRUE(at({Layer::Candidates, Layer::Occupied}));
  EXPECT_EQ(at({Layer::Candidates, Layer::Occupied})->kind, PickedKind::Voxel);
  EXPECT_FALSE(at({}));
}

TEST(Picker, FindsSegmentsByTheSurfaceNearTheHit) {
  const SyntheticRun& run = sharedRun();
  const std::vector<std::uint32_t>& labels = run.record.labels->of_point;
  Eye eye;
  eye.position = run.record.depth->T_world_camera.translation();
  std::set<std::uint32_t> found;
  int right = 0, tried = 0;
  for (std::size_t n = 0; n < labels.size(); n += 37) {
    if (labels[n] == 0) continue;
    Eye toward = eye;
    toward.focus = run.record.surface->points[n].cast<double>();
    const auto picked = under(run, showing({Layer::Segments}), toward, toward.focus);
    if (!picked || picked->kind != PickedKind::Segment) continue;
    ++tried;
    right += picked->id == labels[n];
    found.insert(picked->id);
    EXPECT_EQ(picked->state, VoxelState::Occupied);
  }
  EXPECT_GT(tried, 50);
  EXPECT_GT(right, tried * 9 / 10);
  EXPECT_GE(found.size(), 2u);
}

TEST(Picker, FindsContourPointsAtFootAndTip) {
  const SyntheticRun& run = sharedRun();
  const ContourPoint& point = run.record.contours->points.front();
  Eye eye;
  eye.focus = point.position_m;
  eye.position = point.position_m + 0.5 * point.normal + Eigen::Vector3d(0.05, 0.05, 0.05);
  for (const Eigen::Vector3d& p :
       {point.position_m, Eigen::Vector3d(point.position_m + 0.055 * point.normal)}) {
    const auto picked = under(run, showing({Layer::ContourPoints}), eye, p);
    ASSERT_TRUE(picked);
    EXPECT_EQ(picked->kind, PickedKind::ContourPoint);
    EXPECT_LT((run.record.contours->points[picked->id].position_m - point.position_m).norm(), 0.1);
  }
}

}  // namespace
}  // namespace vantage
