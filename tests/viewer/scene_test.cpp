#include "viewer/scene.h"

#include <gtest/gtest.h>
#include <vtkActor.h>
#include <vtkCoordinate.h>
#include <vtkDataArray.h>
#include <vtkMapper.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkTextActor.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "core/gpu/egl_context.h"
#include "io/error.h"
#include "tests/support/synthetic_record.h"
#include "viewer/contour_marks.h"
#include "viewer/layers/layer.h"
#include "viewer/offscreen_renderer.h"
#include "viewer/segment_scores.h"

namespace vantage {
namespace {

using test::SyntheticRun;

const SyntheticRun& sharedRun() {
  static const SyntheticRun run = test::makeSyntheticRun();
  return run;
}

ViewSettings allLayers() {
  ViewSettings view;
  for (int i = 0; i < kLayerCount; ++i) view.layers.set(static_cast<Layer>(i), true);
  return view;
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

std::size_t distinctColors(const RgbImage& image) {
  std::set<std::array<std::uint8_t, 3>> colors;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) colors.insert(image.at(x, y));
  }
  return colors.size();
}

vtkActor* actorOf(const LayerContent& content, std::size_t index = 0) {
  return index < content.props.size() ? vtkActor::SafeDownCast(content.props[index]) : nullptr;
}

vtkIdType cellsOf(const LayerContent& content, std::size_t index = 0) {
  vtkActor* actor = actorOf(content, index);
  return actor ? vtkPolyData::SafeDownCast(actor->GetMapper()->GetInput())->GetNumberOfCells() : -1;
}

/// Tested in octree_layers_test.cpp; a contour step has none of them.
bool ofOctree(Layer layer) {
  static constexpr Layer kOnly[] = {Layer::ObjectBox, Layer::Octree,     Layer::UtilitySphere,
                                    Layer::HitVoxels, Layer::CoarseRays, Layer::RefinedRays};
  return std::ranges::find(kOnly, layer) != std::end(kOnly);
}

bool ofArm(Layer layer) {
  return layer == Layer::Arm || layer == Layer::ArmMotion || layer == Layer::ClearBoxes;
}

class SceneTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { unsetenv("DISPLAY"); }
  RgbImage draw(const SceneFrame& frame, const ViewSettings& view, int width = 480, int height = 300) {
    Scene scene;
    scene.setFrame(frame);
    scene.show(view, {"Title", "run", "figures"}, PageStyle::Full, width, height);
    return renderer_.render(scene.renderers(), width, height);
  }
  EglContext context_;
  OffscreenRenderer renderer_{context_};
};

TEST(Layers, SyntheticRunHasEveryProduct) {
  const StepRecord& record = sharedRun().record;
  ASSERT_TRUE(record.contours && record.surface && record.saliency && record.search && record.depth);
  EXPECT_GT(record.contours->points.size(), 20u);
  EXPECT_GE(record.saliency->segments.size(), 2u);
  EXPECT_TRUE(record.hasView());
}

TEST(Layers, EachDrawsAsManyThingsAsItsProductHas) {
  const SyntheticRun& run = sharedRun();
  const LayerStyle style;
  EXPECT_EQ(cellsOf(buildLayer(Layer::ContourVoxels, run.frame(), style)),
            static_cast<vtkIdType>(run.record.contours->voxels.size()));
  const LayerContent points = buildLayer(Layer::ContourPoints, run.frame(), style);
  EXPECT_EQ(cellsOf(points, 0), static_cast<vtkIdType>(run.record.contours->points.size()));
  EXPECT_EQ(cellsOf(points, 1), static_cast<vtkIdType>(run.record.contours->points.size()));
  EXPECT_EQ(cellsOf(buildLayer(Layer::Candidates, run.frame(), style)),
            static_cast<vtkIdType>(run.record.positions->size()));
  EXPECT_EQ(cellsOf(buildLayer(Layer::Surface, run.frame(), style)),
            static_cast<vtkIdType>(run.record.surface->triangles.size()));
  EXPECT_EQ(cellsOf(buildLayer(Layer::Workspace, run.frame(), style)), 12);
}

TEST(Layers, RankedViewsDrawNoMoreThanAskedForAndNameTheirUnit) {
  LayerStyle style;
  style.ranked_views = 5;
  style.unreachable_views = 0;
  const LayerContent content = buildLayer(Layer::RankedViews, sharedRun().frame(), style);
  ASSERT_FALSE(content.props.empty());
  EXPECT_EQ(cellsOf(content), 5 * 8);
  ASSERT_TRUE(content.scale);
  EXPECT_NE(content.scale->title.find("rays"), std::string::npos);
}

TEST(Layers, PosesOfAContourPointAreAllOfThemAboutThePointOfTheChosenView) {
  const SyntheticRun& run = sharedRun();
  const auto shown = shownPoses(run.frame(), {});
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->point, run.record.search->chosen->contour_point);
  EXPECT_EQ(shown->view, run.record.search->chosen->id);
  const ContourViewConfig& config = run.header.contour_config.views;
  ASSERT_EQ(shown->poses.size(), static_cast<std::size_t>(config.posesPerPoint()));
  const Eigen::Vector3d& point = run.record.contours->points[shown->point].position_m;
  int straight = 0;
  for (const PointPose& pose : shown->poses) {
    EXPECT_LT((pose.T_world_camera * Eigen::Vector3d(0, 0, config.distances_m[0]) - point).norm(), 1e-6);
    EXPECT_TRUE(pose.T_world_camera.isApprox(*poseOfCandidate(run.frame(), pose.id), 1e-12));
    straight += pose.straight;
  }
  EXPECT_EQ(straight, config.rolls);
  LayerStyle other;
  other.view_id = 0;
  EXPECT_EQ(shownPoses(run.frame(), other)->point, 0u);
  const LayerContent content = buildLayer(Layer::ContourPoses, run.frame(), {});
  EXPECT_EQ(cellsOf(content), 5 * (config.rolls - 1) * 4) << "images of the other rolls";
  EXPECT_EQ(content.must_see.size(), shown->poses.size() * 5);
  other.view_id = 100'000'000;
  EXPECT_THROW(buildLayer(Layer::ContourPoses, run.frame(), other), InputError);
}

TEST(Layers, SurfaceNormalsAreThoseOfTheNearestVertices) {
  SurfaceCloud cloud;
  cloud.points = {{0, 0, 0}, {1, 0, 0}};
  cloud.normals = {{0, 0, 1}, {1, 0, 0}};
  const std::vector<ContourPoint> points = {{{0.4, 0.1, 0.0}, {0, 1, 0}, 1}, {{0.6, 0.1, 0.0}, {0, 1, 0}, 1}};
  const auto normals = surfaceNormalsAt(points, cloud);
  ASSERT_EQ(normals.size(), 2u);
  EXPECT_EQ(normals[0], Eigen::Vector3d::UnitZ());
  EXPECT_EQ(normals[1], Eigen::Vector3d::UnitX());
  EXPECT_TRUE(surfaceNormalsAt(points, {}).empty());
  EXPECT_EQ(cellsOf(buildLayer(Layer::SurfaceNormals, sharedRun().frame(), {})),
            static_cast<vtkIdType>(sharedRun().record.contours->points.size()));
}

TEST(Layers, SegmentsAreColouredByThePartThatIsAskedFor) {
  LayerStyle style;
  style.saliency_max = 1.0;
  EXPECT_EQ(buildLayer(Layer::Segments, sharedRun().frame(), style).scale->title, "saliency of the segment");
  style.saliency_part = SaliencyPart::Isolation;
  style.isolation_distance_m = 0.05;
  const LayerContent content = buildLayer(Layer::Segments, sharedRun().frame(), style);
  EXPECT_EQ(content.scale->title, "isolation F, B_th = 5 cm");
  auto* mesh = vtkPolyData::SafeDownCast(actorOf(content)->GetMapper()->GetInputDataObject(0, 0));
  ASSERT_NE(mesh, nullptr);
  auto* colors = mesh->GetPointData()->GetScalars();
  ASSERT_NE(colors, nullptr);
  const std::vector<Segment> segments = shownSegments(sharedRun().frame(), style);
  const std::vector<std::uint32_t>& labels = sharedRun().record.labels->of_point;
  ASSERT_EQ(static_cast<std::size_t>(colors->GetNumberOfTuples()), labels.size());
  for (std::size_t i = 0; i < labels.size(); i += 97) {
    const Rgb wanted =
        labels[i] == 0 ? palette::kNoSegment : colorAt(ColorMap::Viridis, segments[labels[i] - 1].isolation);
    for (int c = 0; c < 3; ++c)
      ASSERT_EQ(colors->GetComponent(static_cast<vtkIdType>(i), c), wanted.bytes()[c]) << "point " << i;
  }
}

TEST(Layers, EveryColouredLayerHasALegend) {
  for (int i = 0; i < kLayerCount; ++i) {
    const Layer layer = static_cast<Layer>(i);
    if (layer == Layer::Axes || ofOctree(layer) || ofArm(layer)) continue;  // the axes' letters say it
    const LayerContent content = buildLayer(layer, sharedRun().frame(), {});
    EXPECT_FALSE(content.props.empty() && !content.inset) << layerName(layer);
    EXPECT_FALSE(content.legend.empty() && !content.scale && !content.inset) << layerName(layer);
  }
}

TEST(Layers, FirstTriedSegmentIsNumberedLastSoThatNothingCoversIt) {
  const StepRecord& record = sharedRun().record;
  const LayerContent content = buildLayer(Layer::SegmentRanks, sharedRun().frame(), {});
  ASSERT_GE(content.props.size(), 2u);
  const auto* first = vtkTextActor::SafeDownCast(content.props.back());  // 2D: drawn over the scene
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(std::string(const_cast<vtkTextActor*>(first)->GetInput()), " 1 ");
  const Segment& segment = record.saliency->segments.at(record.search->segments.front().segment);
  const double* at = const_cast<vtkTextActor*>(first)->GetPositionCoordinate()->GetValue();
  EXPECT_LT((Eigen::Vector3d(at) - segment.center_m).norm(), 1e-9);
}

TEST(Layers, SliceEndsAtTheWorkspace) {
  const SyntheticRun& run = sharedRun();
  for (int axis = 0; axis < 3; ++axis) {
    LayerStyle style;
    style.slices = {};
    style.slices[axis].shown = true;
    const LayerContent content = buildLayer(Layer::Slices, run.frame(), style);
    ASSERT_NE(actorOf(content), nullptr);
    const double* bounds = actorOf(content)->GetBounds();
    Box drawn(Eigen::Vector3d(bounds[0], bounds[2], bounds[4]),
              Eigen::Vector3d(bounds[1], bounds[3], bounds[5]));
    EXPECT_LE(drawn.sizes()[axis], 1e-9);
    Box allowed = run.header.workspace;
    allowed.min().array() -= run.header.volume.voxel_size_m;
    allowed.max().array() += run.header.volume.voxel_size_m;
    EXPECT_TRUE(allowed.contains(drawn)) << "axis " << axis;
    style.slices[axis].at_m = allowed.max()[axis] + 0.1;
    EXPECT_TRUE(buildLayer(Layer::Slices, run.frame(), style).props.empty()) << "axis " << axis;
  }
}

TEST(Layers, UnknownIsTranslucentAndMoreThanTheCapIsRefused) {
  LayerStyle style;
  const LayerContent content = buildLayer(Layer::Unknown, sharedRun().frame(), style);
  ASSERT_NE(actorOf(content), nullptr);
  EXPECT_LE(actorOf(content)->GetProperty()->GetOpacity(), 0.15);
  style.unknown_opacity = 0.5;
  EXPECT_THROW(style.validate(), std::invalid_argument);
}

TEST(Layers, NamesLeadBackToLayers) {
  EXPECT_EQ(layerNames().size(), static_cast<std::size_t>(kLayerCount));
  for (const std::string_view name : layerNames()) {
    ASSERT_TRUE(layerNamed(name)) << name;
    EXPECT_EQ(layerName(*layerNamed(name)), name);
  }
  EXPECT_FALSE(layerNamed("contour-pints"));
}

TEST_F(SceneTest, DrawsWithoutADisplayInTheColoursOfItsLegend) {
  ViewSettings view;
  view.layers = {Layer::Surface, Layer::ChosenView, Layer::ContourPoints};
  const RgbImage image = draw(sharedRun().frame(), view, 640, 400);
  EXPECT_GT(distinctColors(image), 100u);
  EXPECT_GT(countColor(image, palette::kChosen, 12), 40);
  EXPECT_GT(countColor(image, palette::kNormal, 12), 40);
  EXPECT_GT(countColor(image, palette::kPaper, 2), image.width * image.height / 4);
}

TEST(Focus, OnTheSegmentTheEyeComesNearerAndLooksAtIt) {
  Scene scene;
  const auto eyeFor = [&](const SyntheticRun& run, CameraFocus focus) {
    ViewSettings view;
    view.layers = {Layer::Surface};
    view.camera.focus = focus;
    scene.setFrame(run.frame());
    scene.arrange(view);
    scene.placeEye(view.camera, 1.6);
    return scene.eye();
  };
  const Eye far = eyeFor(sharedRun(), CameraFocus::Workspace),
            near = eyeFor(sharedRun(), CameraFocus::Segment);
  EXPECT_LT(near.distance(), 0.95 * far.distance());
  const Sphere& sphere = shownSearch(sharedRun().record)->sphere;
  EXPECT_LT((near.focus - sphere.center).norm(), 0.2 * sphere.radius);
  const SyntheticRun empty = test::makeEmptyRun();
  EXPECT_EQ(eyeFor(empty, CameraFocus::Segment), eyeFor(empty, CameraFocus::Workspace));
}

TEST_F(SceneTest, TranslucentFrontierTintsThePicture) {
  ViewSettings with, without;
  with.layers = {Layer::Occupied, Layer::Unknown};
  without.layers = {Layer::Occupied};
  const RgbImage a = draw(sharedRun().frame(), with), b = draw(sharedRun().frame(), without);
  int changed = 0;
  for (int y = 40; y < a.height; ++y) {
    for (int x = 0; x < a.width / 2; ++x) changed += a.at(x, y) != b.at(x, y);
  }
  EXPECT_GT(changed, 200);
}

TEST_F(SceneTest, TwoRendersAreEqualByteForByte) {
  const RgbImage first = draw(sharedRun().frame(), allLayers());
  EXPECT_EQ(first, draw(sharedRun().frame(), allLayers()));
  OffscreenRenderer other(context_);
  Scene scene;
  scene.setFrame(sharedRun().frame());
  scene.show(allLayers(), {"Title", "run", "figures"}, PageStyle::Full, 480, 300);
  EXPECT_EQ(first, other.render(scene.renderers(), 480, 300));
}

TEST_F(SceneTest, PictureGrowsUntilADistantSensorIsInIt) {
  SyntheticRun run = sharedRun();
  ASSERT_TRUE(run.record.depth);
  ViewSettings view;
  view.layers = {Layer::Sensor};
  DepthFrame depth = *run.record.depth;
  for (const double x_m : {-4.0, 4.0}) {
    depth.T_world_camera.translation() = Eigen::Vector3d(x_m, 0.0, 0.5);
    run.record.depth = std::make_shared<DepthFrame>(depth);
    Scene scene;
    scene.setFrame(run.frame());
    scene.show(view, {}, PageStyle::ViewOnly, 960, 600);  // no legend, no text in similar colours
    EXPECT_GT(countColor(renderer_.render(scene.renderers(), 960, 600), palette::kSensor, 12), 40) << x_m;
  }
}

TEST_F(SceneTest, MissingProductsAreLeftOut) {
  const SyntheticRun empty = test::makeEmptyRun();
  EXPECT_NO_THROW(draw(empty.frame(), allLayers()));

  SyntheticRun run = sharedRun();
  run.record.surface.reset();
  EXPECT_NO_THROW(draw(run.frame(), allLayers()));
  run.record.search.reset();
  run.record.contours.reset();
  EXPECT_NO_THROW(draw(run.frame(), allLayers()));
  const SceneFrame no_truth{run.header, run.record, run.states, nullptr};
  EXPECT_NO_THROW(draw(no_truth, allLayers()));
  RunHeader bare;
  const StateGrid nothing;
  const StepRecord no_record;
  EXPECT_NO_THROW(draw(SceneFrame{bare, no_record, nothing, nullptr}, allLayers()));
}

TEST_F(SceneTest, StepWithoutAChosenViewIsDrawn) {
  const SyntheticRun run = test::makeSyntheticRun(false);
  ASSERT_FALSE(run.record.hasView());
  ViewSettings view;
  view.layers = {Layer::ChosenView, Layer::Path, Layer::RankedViews};
  const RgbImage image = draw(run.frame(), view);
  EXPECT_EQ(countColor(image, palette::kChosen, 12), 0);
}

TEST_F(SceneTest, SizesOutOfRangeAreRefused) {
  Scene scene;
  EXPECT_THROW(scene.show({}, {}, PageStyle::Full, 100, 100), std::logic_error);
  scene.setFrame(sharedRun().frame());
  scene.show({}, {}, PageStyle::ViewOnly, 100, 100);
  EXPECT_THROW(renderer_.render(scene.renderers(), 4, 100), std::invalid_argument);
  EXPECT_THROW(renderer_.render(scene.renderers(), 100, 100000), std::invalid_argument);
}

TEST(FitEye, KeepsEveryCornerInThePicture) {
  for (const double shape : {0.5, 1.0, 2.5}) {
    const Box box(Eigen::Vector3d(-1.0, -1.0, 0.0), Eigen::Vector3d(1.0, 0.66, 1.0));
    const CameraView view;
    std::vector<Eigen::Vector3d> corners;
    for (int c = 0; c < 8; ++c) corners.push_back(box.corner(static_cast<Box::CornerType>(c)));
    const Eye eye = fitEye(view, corners, shape);
    const Eigen::Vector3d forward = (eye.focus - eye.position).normalized();
    const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized(),
                          up = right.cross(forward);
    double widest = 0.0;
    for (int c = 0; c < 8; ++c) {
      const Eigen::Vector3d p = box.corner(static_cast<Box::CornerType>(c)) - eye.position;
      const double tan_v = std::tan(view.fov_rad / 2);
      const double x = std::abs(p.dot(right) / p.dot(forward)) / (tan_v * shape),
                   y = std::abs(p.dot(up) / p.dot(forward)) / tan_v;
      EXPECT_LE(std::max(x, y), 1.01);
      widest = std::max({widest, x, y});
    }
    EXPECT_GE(widest, 0.97);
  }
}

}  // namespace
}  // namespace vantage
