#include "viewer/map_session.h"

#include <gmock/gmock.h>

#include "io/cloud_file.h"
#include "io/error.h"
#include "io/octree_file.h"
#include "io/volume_file.h"
#include "tests/support/process.h"
#include "tests/support/synthetic_record.h"
#include "viewer/captions.h"
#include "viewer/layers/layer.h"
#include "viewer/scene.h"

namespace vantage::test {
namespace {

using ::testing::HasSubstr;

/// Layers, frame and captions must work with whatever the step holds.
void expectDrawable(const StepData& data) {
  ASSERT_FALSE(data.empty());
  const SceneFrame frame = data.frame();
  EXPECT_GT(data.header->workspace.volume(), 0.0);
  Scene scene;
  scene.setFrame(frame);
  ViewSettings view;
  for (const std::string_view name : layerNames()) view.layers.set(*layerNamed(name), true);
  EXPECT_NO_THROW(scene.show(view, {"title", stepLine(frame), viewFigures(frame, view.style)},
                             PageStyle::Full, 640, 480));
  for (const auto& figures : {scanFigures, stateFigures, contourFigures, segmentFigures, viewFigures,
                              octreeFigures, rayFigures, utilityFigures})
    EXPECT_FALSE(figures(frame, view.style).empty());
}

TEST(MapSession, ShowsATsdfByItsStatesAndSurface) {
  const TemporaryFolder folder;
  const SyntheticRun run = makeSyntheticRun();
  writeVolume(folder / "map.vti", run.volume);
  const StepData data = openAsStep(folder / "map.vti");
  expectDrawable(data);
  ASSERT_TRUE(data.volume && !data.octree);
  EXPECT_TRUE(std::ranges::equal(data.volume->voxels(), run.volume.voxels()));
  EXPECT_TRUE(std::ranges::equal(data.states->states(), run.states.states()));
  EXPECT_GT(data.record->surface->points.size(), 100u);
  EXPECT_TRUE(data.header->workspace.isApprox(run.volume.geometry().bounds()));
}

TEST(MapSession, ShowsAnOctreeWithItsNodes) {
  const TemporaryFolder folder;
  const SyntheticOctreeRun run = makeSyntheticOctreeRun();
  writeOctree(folder / "map.ot", run.octree);
  const StepData data = openAsStep(folder / "map.ot");
  expectDrawable(data);
  ASSERT_TRUE(data.octree && data.pyramid && data.tree && !data.volume);
  EXPECT_TRUE(onOctree(data.frame()));
  EXPECT_TRUE(data.header->octree->object_box.isApprox(run.header.octree->object_box, 1e-6));
  EXPECT_EQ(data.states->count(VoxelState::Occupied, data.header->workspace),
            run.pyramid.finest().count(VoxelState::Occupied, run.pyramid.finest().geometry().bounds()));
}

TEST(MapSession, ShowsScenesByNameAndFromFiles) {
  const StepData built_in = openAsStep("tabletop");
  expectDrawable(built_in);
  EXPECT_GT(built_in.header->truth.triangles.size(), 1000u);
  EXPECT_EQ(built_in.states->count(VoxelState::Free, built_in.header->workspace), 0u);
  const TemporaryFolder folder;
  writeFile(folder / "cube.toml", "[[solid]]\nkind = \"box\"\nsize_m = [0.2, 0.2, 0.2]\n");
  const StepData own = openAsStep(folder / "cube.toml");
  expectDrawable(own);
  EXPECT_EQ(own.header->truth.triangles.size(), 12u);
  EXPECT_EQ(own.header->input, "cube");
}

TEST(MapSession, ShowsCloudsAsSurfaceAndMeshesAsTruth) {
  const TemporaryFolder folder;
  SurfaceCloud cloud;
  for (int i = 0; i < 200; ++i) {
    cloud.points.emplace_back(0.01f * i, 0.02f * (i % 7), 1.0f);
    cloud.normals.push_back(Eigen::Vector3f::UnitZ());
  }
  writeCloud(folder / "cloud.pcd", cloud);
  const StepData points = openAsStep(folder / "cloud.pcd");
  expectDrawable(points);
  EXPECT_EQ(points.record->surface->points, cloud.points);
  EXPECT_FALSE(buildLayer(Layer::Surface, points.frame(), {}).props.empty());
  for (const Eigen::Vector3f& p : cloud.points)
    EXPECT_TRUE(points.header->workspace.contains(p.cast<double>()));

  cloud.triangles = {{0, 1, 2}, {3, 4, 5}};
  writeMesh(folder / "mesh.ply", cloud);
  const StepData mesh = openAsStep(folder / "mesh.ply");
  expectDrawable(mesh);
  EXPECT_FALSE(buildLayer(Layer::Truth, mesh.frame(), {}).props.empty());
  EXPECT_EQ(mesh.header->truth.triangles.size(), 2u);
  EXPECT_FALSE(mesh.record->surface);
}

TEST(MapSession, ShowsTablesOfViewsAloneAndOverAStep) {
  const TemporaryFolder folder;
  const std::vector<ViewRow> views = {{3, lookAt({0.0, -1.0, 0.5}, {0.0, 0.0, 0.0}), {}},
                                      {9, lookAt({1.0, 0.0, 0.5}, {0.0, 0.0, 0.0}), {}}};
  writeViews(folder / "views.csv", views);
  const StepData alone = openAsStep(folder / "views.csv");
  expectDrawable(alone);
  ASSERT_EQ(alone.record->positions->size(), 2u);

  const SyntheticRun run = makeSyntheticRun();
  StepData step;
  step.header = std::make_shared<const RunHeader>(run.header);
  step.record = std::make_shared<const StepRecord>(run.record);
  step.states = std::make_shared<const StateGrid>(run.states);
  const StepData over = withViews(step, readViews(folder / "views.csv"));
  expectDrawable(over);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewPosition& position = (*over.record->positions)[i];
    EXPECT_TRUE(poseOfCandidate(over.frame(), position.first_id)->isApprox(views[i].T_world_camera, 1e-9))
        << i;
  }
  EXPECT_FALSE(over.record->hasView());
  EXPECT_TRUE(over.record->surface);
  EXPECT_TRUE(step.record->hasView()) << "the step itself is as it was";
}

TEST(MapSession, SaysWhatToDoWithWhatCannotBeShown) {
  const TemporaryFolder folder;
  const auto refusal = [](const std::string& file) -> std::string {
    try {
      openAsStep(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no InputError";
  };
  writeFile(folder / "recipe.toml", "layers = [\"surface\"]\n");
  writeFile(folder / "broken.vti", "<VTKFile");
  writeFile(folder / "empty.pcd", "");
  EXPECT_THAT(refusal(folder / "recipe.toml"), HasSubstr("is a recipe"));
  EXPECT_THAT(refusal(folder / "broken.vti"), HasSubstr("broken.vti"));
  EXPECT_THAT(refusal(folder / "empty.pcd"), HasSubstr("empty.pcd"));
  EXPECT_THAT(refusal(folder / "none.ply"), HasSubstr("does not exist"));
}

}  // namespace
}  // namespace vantage::test
