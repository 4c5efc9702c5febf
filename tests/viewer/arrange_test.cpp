#include <gtest/gtest.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkNew.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cstdlib>

#include "core/gpu/egl_context.h"
#include "tests/support/synthetic_record.h"
#include "viewer/layers/layer.h"
#include "viewer/layers/shapes.h"
#include "viewer/offscreen_renderer.h"
#include "viewer/scene.h"
#include "viewer/viewport.h"

namespace vantage {
namespace {

using test::SyntheticRun;

const SyntheticRun& sharedRun() {
  static const SyntheticRun run = test::makeSyntheticRun();
  return run;
}

std::shared_ptr<const void> someMap() {
  static const auto map = std::make_shared<int>(1);
  return map;
}

SceneFrame frameOf(const SyntheticRun& run, std::shared_ptr<const void> map = someMap()) {
  SceneFrame frame = run.frame();
  frame.map = std::move(map);
  return frame;
}

ViewSettings viewOf(LayerSet layers) {
  ViewSettings view;
  view.layers = layers;
  return view;
}

int pixelsNear(const RgbImage& image, Rgb wanted, int tolerance) {
  const auto target = wanted.bytes();
  int count = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    int worst = 0;
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(image.pixels[i + c] - target[c]));
    count += worst <= tolerance;
  }
  return count;
}

int differentPixels(const RgbImage& a, const RgbImage& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); i += 3)
    count += !std::equal(a.pixels.begin() + i, a.pixels.begin() + i + 3, b.pixels.begin() + i);
  return count;
}

const LayerSet kMany = {Layer::Workspace,   Layer::Occupied,   Layer::Unknown,
                        Layer::Segments,    Layer::Truth,      Layer::Candidates,
                        Layer::RankedViews, Layer::ChosenView, Layer::ContourPoints};

TEST(Arrange, ReRankedRecordRebuildsOnlyWhatDependsOnIt) {
  SyntheticRun run = sharedRun();
  Scene scene;
  scene.setFrame(frameOf(run));
  scene.arrange(viewOf(kMany));
  for (const Layer layer : {Layer::Occupied, Layer::Segments, Layer::RankedViews})
    EXPECT_EQ(scene.timesBuilt(layer), 1) << layerName(layer);

  SyntheticRun other = run;  // with a header of its own, as whoever tries other parameters has
  other.record.saliency = std::make_shared<Saliency>(*run.record.saliency);
  scene.setFrame(frameOf(other));
  scene.arrange(viewOf(kMany));
  EXPECT_EQ(scene.timesBuilt(Layer::Segments), 2);
  for (const Layer layer :
       {Layer::Occupied, Layer::Unknown, Layer::Truth, Layer::RankedViews, Layer::ContourPoints})
    EXPECT_EQ(scene.timesBuilt(layer), 1) << layerName(layer);

  other.header.contour_config.gain.gain_threshold += 1.0;
  scene.setFrame(frameOf(other));
  scene.arrange(viewOf(kMany));
  EXPECT_EQ(scene.timesBuilt(Layer::RankedViews), 2);
  EXPECT_EQ(scene.timesBuilt(Layer::Segments), 2);
  EXPECT_EQ(scene.timesBuilt(Layer::Occupied), 1);
}

TEST(Arrange, AnotherMapOrAnUnknownOneRebuildsItsLayers) {
  Scene scene;
  scene.setFrame(frameOf(sharedRun()));
  scene.arrange(viewOf(kMany));
  scene.setFrame(frameOf(sharedRun(), std::make_shared<int>(2)));
  scene.arrange(viewOf(kMany));
  EXPECT_EQ(scene.timesBuilt(Layer::Occupied), 2);
  EXPECT_EQ(scene.timesBuilt(Layer::Segments), 1);
  for (int i = 0; i < 2; ++i) {
    scene.setFrame(frameOf(sharedRun(), nullptr));
    scene.arrange(viewOf(kMany));
  }
  EXPECT_EQ(scene.timesBuilt(Layer::Occupied), 4);
}

TEST(Arrange, LayersAreBuiltWhenFirstShownAndKeptWhenSwitchedOff) {
  Scene scene;
  scene.setFrame(frameOf(sharedRun()));
  scene.arrange(viewOf({Layer::Occupied}));
  EXPECT_EQ(scene.timesBuilt(Layer::Surface), 0);
  scene.arrange(viewOf({Layer::Occupied, Layer::Surface}));
  scene.arrange(viewOf({Layer::Surface}));
  scene.arrange(viewOf({Layer::Occupied, Layer::Surface}));
  EXPECT_EQ(scene.timesBuilt(Layer::Surface), 1);
  EXPECT_EQ(scene.timesBuilt(Layer::Occupied), 1);
  EXPECT_EQ(scene.shownNotes().size(), 2u);
}

TEST(Arrange, StyleRebuildsOnlyLayersThatReadTheField) {
  Scene scene;
  scene.setFrame(frameOf(sharedRun()));
  ViewSettings view = viewOf(kMany);
  scene.arrange(view);
  view.style.saliency_max = 0.5;
  scene.arrange(view);
  EXPECT_EQ(scene.timesBuilt(Layer::Segments), 2);
  view.style.saliency_part = SaliencyPart::Roundness;
  view.style.isolation_distance_m = 0.05;
  scene.arrange(view);
  EXPECT_EQ(scene.timesBuilt(Layer::Segments), 3);
  view.style.ranked_views = 3;
  scene.arrange(view);
  EXPECT_EQ(scene.timesBuilt(Layer::RankedViews), 2);
  EXPECT_EQ(scene.timesBuilt(Layer::Segments), 3);
  EXPECT_EQ(scene.timesBuilt(Layer::Occupied), 1);
}

TEST(Arrange, LooksAreAppliedWithoutBuildingAndColourMapsBuildOneLayer) {
  Scene scene;
  scene.setFrame(frameOf(sharedRun()));
  ViewSettings view = viewOf(kMany);
  scene.arrange(view);
  const auto property = [&](Layer layer) {
    return vtkActor::SafeDownCast(scene.content(layer)->props.front())->GetProperty();
  };
  const double unknown = property(Layer::Unknown)->GetOpacity();
  const float width = property(Layer::RankedViews)->GetLineWidth();
  view.look(Layer::Unknown).opacity = 0.5;
  view.look(Layer::RankedViews).size = 2.0;
  scene.arrange(view);
  scene.arrange(view);  // not applied twice
  EXPECT_DOUBLE_EQ(property(Layer::Unknown)->GetOpacity(), unknown / 2);
  EXPECT_FLOAT_EQ(property(Layer::RankedViews)->GetLineWidth(), 2 * width);
  for (int i = 0; i < kLayerCount; ++i) EXPECT_LE(scene.timesBuilt(static_cast<Layer>(i)), 1);

  view.look(Layer::Segments).color_map = ColorMap::Cividis;
  scene.arrange(view);
  EXPECT_EQ(scene.timesBuilt(Layer::Segments), 2);
  EXPECT_EQ(scene.timesBuilt(Layer::RankedViews), 1);
  EXPECT_EQ(scene.content(Layer::Segments)->scale->map, ColorMap::Cividis);
  EXPECT_EQ(scene.content(Layer::RankedViews)->scale->map, ColorMap::Viridis);

  view.look(Layer::Segments).size = 7.0;
  EXPECT_THROW(scene.arrange(view), std::invalid_argument);
}

TEST(Arrange, EyeStaysWhereTheUserPutIt) {
  Scene scene;
  scene.setFrame(frameOf(sharedRun()));
  scene.arrange(viewOf(kMany));
  const Eye mine{{1, 2, 3}, {0, 0.1, 0.2}, Eigen::Vector3d::UnitZ(), 0.4};
  scene.setEye(mine);
  scene.setFrame(frameOf(sharedRun(), std::make_shared<int>(5)));
  scene.arrange(viewOf({Layer::Occupied}));
  EXPECT_EQ(scene.eye().position, mine.position);
  EXPECT_EQ(scene.eye().focus, mine.focus);
  scene.placeEye({}, 1.5);
  EXPECT_NE(scene.eye().position, mine.position);
}

TEST(Arrange, NeedsAFrame) {
  Scene scene;
  EXPECT_THROW(scene.arrange({}), std::logic_error);
  scene.setFrame(frameOf(sharedRun()));
  scene.arrange({});
  scene.forget();
  EXPECT_THROW(scene.arrange({}), std::logic_error);
}

TEST(Readable, LeavesWhatStandsOutAndLightensWhatDoesNot) {
  const SceneTheme dark{rgb(24, 26, 30), rgb(230, 232, 235)};
  EXPECT_EQ(readable(palette::kPath, {}), palette::kPath);
  EXPECT_EQ(readable(palette::kUnknown, dark), palette::kUnknown);
  EXPECT_EQ(readable(palette::kRule, {}), palette::kRule);
  EXPECT_LT(readable(palette::kRule, dark).r, 0.5) << "what is faint on paper is faint in the dark";
  EXPECT_GT(readable(palette::kRule, dark).r, 0.15);
  EXPECT_GT(readable(palette::kSensor, dark).r, 0.3);
  EXPECT_GT(readable(palette::kInk, dark).g, 0.3);
}

class WindowTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { unsetenv("DISPLAY"); }
  RgbImage drawn(const ViewSettings& view, const SceneTheme& theme = {}) {
    Scene scene;
    scene.setFrame(frameOf(sharedRun()));
    scene.arrange(view, theme);
    scene.placeEye(view.camera, 1.6);
    Viewport viewport(context_, scene);
    viewport.resize(480, 300);
    return viewport.screenshot();
  }
  EglContext context_;
};

TEST_F(WindowTest, ShowsThePictureThatAPageShows) {
  Scene scene;
  scene.setFrame(frameOf(sharedRun()));
  ViewSettings view = viewOf(kMany);
  scene.show(view, {}, PageStyle::ViewOnly, 1280, 800);
  RgbImage page, again;
  {
    OffscreenRenderer renderer(context_);
    page = renderer.render(scene.renderers(), 1280, 800);
  }
  scene.arrange(view);
  scene.placeEye(view.camera, 1.6);
  Viewport viewport(context_, scene);
  viewport.resize(1280, 800);
  EXPECT_EQ(viewport.screenshot(), page);
  EXPECT_GT(pixelsNear(page, palette::kChosen, 12), 100);
}

/// Draws until nothing is left to do.
void settle(Viewport& viewport) {
  viewport.setMoving(false);
  for (int n = 0; n < 3 && viewport.nextRender_s(); ++n) viewport.render();
}

TEST_F(WindowTest, MergedFacesLookLikeSingleOnes) {
  const SyntheticRun& run = sharedRun();
  OffscreenRenderer renderer(context_);
  for (const double opacity : {1.0, 0.15}) {
    RgbImage images[2];
    for (const bool merged : {false, true}) {
      vtkNew<vtkRenderer> view;
      view->SetBackground(1.0, 1.0, 1.0);
      const auto of = opacity < 1.0 ? VoxelState::Unknown : VoxelState::Occupied;
      const auto rule = opacity < 1.0 ? FaceRule::TowardFree : FaceRule::TowardOther;
      const Box& box = run.header.workspace;
      view->AddActor(
          merged ? faceActor(extractMergedFaces(run.states, of, rule, box), palette::kUnknown, opacity)
                 : faceActor(extractFaces(run.states, of, rule, box), palette::kUnknown, opacity));
      view->ResetCamera();
      view->GetActiveCamera()->Azimuth(30.0);
      view->GetActiveCamera()->Elevation(-50.0);
      vtkRenderer* const renderers[] = {view.Get()};
      images[merged] = renderer.render(renderers, 640, 400);
    }
    EXPECT_GT(640 * 400 - pixelsNear(images[0], rgb(255, 255, 255), 0), 2000);
    int different = 0;
    for (std::size_t i = 0; i < images[0].pixels.size(); ++i)
      different += std::abs(images[0].pixels[i] - images[1].pixels[i]) > 3;
    EXPECT_LT(different, 90) << "of " << images[0].pixels.size() << " values, opacity " << opacity;
  }
}

TEST_F(WindowTest, DrawsOnlyWhenSomethingChanged) {
  Scene scene;
  scene.setFrame(frameOf(sharedRun()));
  scene.arrange(viewOf(kMany));
  Viewport viewport(context_, scene);
  viewport.resize(320, 200);
  EXPECT_EQ(viewport.nextRender_s(), 0.0);
  EXPECT_FALSE(viewport.settled());
  EXPECT_TRUE(viewport.render());
  EXPECT_NE(viewport.texture(), 0u);
  settle(viewport);
  EXPECT_TRUE(viewport.settled());
  EXPECT_FALSE(viewport.nextRender_s());
  const auto still = [&] { return !viewport.render() && viewport.settled(); };
  EXPECT_TRUE(still());
  viewport.move({10, 10});  // without a press
  EXPECT_TRUE(still());
  viewport.resize(320, 200);
  EXPECT_TRUE(still());
  const std::uint64_t frames = viewport.framesRendered();
  viewport.requestRender();
  EXPECT_TRUE(viewport.render());
  EXPECT_EQ(viewport.framesRendered(), frames + 1);
}

TEST_F(WindowTest, DragOrbitsAndAFullPictureFollows) {
  Scene scene;
  scene.setFrame(frameOf(sharedRun()));
  scene.arrange(viewOf(kMany));
  scene.placeEye({}, 1.6);
  Viewport viewport(context_, scene);
  viewport.resize(320, 200);
  const RgbImage before = viewport.screenshot();
  const Eye eye = scene.eye();
  viewport.press(Drag::Orbit, {100, 100});
  viewport.move({140, 90});
  EXPECT_TRUE(viewport.dragging());
  EXPECT_TRUE(viewport.render());
  viewport.release();
  viewport.move({200, 100});
  EXPECT_NEAR(scene.eye().distance(), eye.distance(), 1e-9);
  EXPECT_GT((scene.eye().position - eye.position).norm(), 0.1);
  if (!viewport.settled()) {  // a rough picture is followed by a full one
    ASSERT_TRUE(viewport.nextRender_s());
    EXPECT_LE(*viewport.nextRender_s(), Viewport::kSettle_s);
  }
  settle(viewport);
  EXPECT_TRUE(viewport.settled());
  EXPECT_GT(differentPixels(before, viewport.screenshot()), 1000);
  viewport.wheel(2.0, {160, 100});
  EXPECT_LT(scene.eye().distance(), eye.distance());
}

TEST_F(WindowTest, ClipBoxCutsMapsAndLeavesViewsWhole) {
  ViewSettings view = viewOf({Layer::Occupied, Layer::ChosenView});
  const RgbImage whole = drawn(view);
  view.clip = Box(Eigen::Vector3d(0.0, -10.0, -10.0), Eigen::Vector3d(10.0, 10.0, 10.0));
  const RgbImage half = drawn(view);
  view.clip = Box(Eigen::Vector3d(50.0, 50.0, 50.0), Eigen::Vector3d(51.0, 51.0, 51.0));
  const RgbImage none = drawn(view);
  const auto empty = [](const RgbImage& image) { return pixelsNear(image, palette::kPaper, 2); };
  EXPECT_GT(empty(half), empty(whole) + 1000);
  EXPECT_GT(empty(none), empty(half) + 1000);
  EXPECT_GE(pixelsNear(none, palette::kChosen, 12), pixelsNear(whole, palette::kChosen, 12));
  view.clip = Box();
  EXPECT_THROW(drawn(view), std::invalid_argument);
}

TEST_F(WindowTest, DarkThemeHasItsBackgroundAndReadableLines) {
  const SceneTheme dark{rgb(24, 26, 30), rgb(230, 232, 235)};
  const RgbImage image = drawn(viewOf({Layer::Sensor, Layer::Axes}), dark);
  EXPECT_GT(pixelsNear(image, dark.background, 1), image.width * image.height / 2);
  EXPECT_EQ(pixelsNear(image, palette::kPaper, 2), 0);
  EXPECT_GT(pixelsNear(image, readable(palette::kSensor, dark), 12), 100);
}

TEST_F(WindowTest, InsetLooksFromElsewhereAndLeavesTheView) {
  Scene scene;
  scene.setFrame(frameOf(sharedRun()));
  scene.arrange(viewOf({Layer::Surface, Layer::Sensor}));
  scene.placeEye({}, 1.6);
  Viewport viewport(context_, scene);
  viewport.resize(480, 300);
  const RgbImage before = viewport.screenshot();
  settle(viewport);
  const ChosenView& chosen = *sharedRun().record.chosen();
  vtkRenderer* inset = scene.inset(eyeOfView(sharedRun().header.camera, chosen.T_world_camera),
                                   {Layer::Surface, Layer::ContourPoints});
  const RgbImage image = viewport.picture({&inset, 1}, 240, 200);
  EXPECT_EQ(image.width, 240);
  EXPECT_GT(pixelsNear(image, palette::kNormal, 12), 20) << "a layer that the view lacks";
  EXPECT_LT(pixelsNear(image, palette::kPaper, 2), image.width * image.height / 2);
  EXPECT_FALSE(viewport.render()) << "the view's picture is kept";
  const RgbImage after = viewport.screenshot();
  EXPECT_EQ(differentPixels(after, before), 0);
  EXPECT_THROW(viewport.picture({&inset, 1}, 4, 4), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
