#include <benchmark/benchmark.h>

#include <memory>

#include "core/exploration/explorer.h"
#include "core/exploration/plan_view.h"
#include "core/gpu/egl_context.h"
#include "io/config_file.h"
#include "io/scene_file.h"
#include "tests/benchmarks/tabletop_map.h"
#include "viewer/merged_faces.h"
#include "viewer/viewport.h"

// What the inspector does to the embedded scene `tabletop` after its initial scan, in a picture of 1280 x 800
// without a display: turning the scene, a still, and the picture after something changed.

namespace vantage {
namespace {

constexpr int kWidth = 1280, kHeight = 800;

/// A planned step as a run would have it.
struct Tabletop {
  Settings settings;
  RunHeader header;
  TsdfVolume volume;
  std::shared_ptr<StateGrid> states;
  StepRecord record;

  Tabletop() {
    const benchmarks::TabletopMap& map = benchmarks::tabletopMap();
    settings = map.settings;
    volume = map.volume;
    states = std::make_shared<StateGrid>(map.states);
    const ExplorationConfig& config = settings.exploration;
    const PlanViewInput input{.volume = volume,
                              .states = *states,
                              .camera = settings.camera,
                              .workspace = config.workspace,
                              .config = config.contour};
    const ReachPose reach = [](const Pose&) {
      MotionPlan plan;
      plan.verdict = Reachability::Reachable;
      return plan;
    };
    planView(record, input, reach, [](Stage) {}, {});
    header.planner = "contour";
    header.camera = settings.camera;
    header.volume = config.volume;
    header.workspace = config.workspace;
    header.contour_config = config.contour;
  }
  SceneFrame frame() const { return {header, record, *states, nullptr, nullptr, nullptr, states}; }
};

const Tabletop& tabletop() {
  static const Tabletop scene;
  return scene;
}

EglContext& context() {
  static EglContext context;
  return context;
}

const LayerSet kMap = {Layer::Workspace, Layer::Axes, Layer::Occupied, Layer::Unknown};
const LayerSet kPlanning = {Layer::Workspace,   Layer::Axes,       Layer::Segments, Layer::Unknown,
                            Layer::RankedViews, Layer::ChosenView, Layer::Path};

/// A window on the scene.
struct Window {
  Scene scene;
  ViewSettings settings;
  Viewport viewport{context(), scene};

  explicit Window(const LayerSet& layers) {
    settings.layers = layers;
    scene.setFrame(tabletop().frame());
    scene.arrange(settings);
    scene.placeEye(settings.camera, static_cast<double>(kWidth) / kHeight);
    viewport.resize(kWidth, kHeight);
    viewport.render();
  }
  void turn() {
    scene.setEye(orbited(scene.eye(), 0.03, 0.0));
    viewport.requestRender();
  }
  void redraw() {
    scene.arrange(settings);
    viewport.requestRender();
    viewport.render();
  }
};

void label(benchmark::State& state) {
  state.SetLabel("tabletop, 1280x800, " + context().describe());
}

void countFaces(benchmark::State& state) {
  const Box& workspace = tabletop().settings.exploration.workspace;
  double faces = 0.0, rectangles = 0.0, triangles = 0.0;
  for (const auto& [voxels, rule] : {std::pair{VoxelState::Occupied, FaceRule::TowardOther},
                                     {VoxelState::Unknown, FaceRule::TowardFree}}) {
    const MergedFaces merged = extractMergedFaces(*tabletop().states, voxels, rule, workspace);
    faces += static_cast<double>(merged.faces);
    rectangles += static_cast<double>(merged.rectangles);
    triangles += static_cast<double>(merged.triangles.size());
  }
  state.counters["faces"] = faces;
  state.counters["rectangles"] = rectangles;
  state.counters["triangles"] = triangles;
}

/// Occupied voxels and the frontier, one by one or merged.
void extractAllFaces(benchmark::State& state) {
  const Box& workspace = tabletop().settings.exploration.workspace;
  const bool merged = state.range(0) == 1;
  for (auto _ : state) {
    for (const auto& [voxels, rule] : {std::pair{VoxelState::Occupied, FaceRule::TowardOther},
                                       {VoxelState::Unknown, FaceRule::TowardFree}}) {
      if (merged)
        benchmark::DoNotOptimize(extractMergedFaces(*tabletop().states, voxels, rule, workspace));
      else
        benchmark::DoNotOptimize(extractFaces(*tabletop().states, voxels, rule, workspace));
    }
  }
  countFaces(state);
}
BENCHMARK(extractAllFaces)
    ->ArgName("merged")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// A frame while the scene is turned, or the full one that follows.
void orbitFrame(benchmark::State& state) {
  Window window(state.range(0) == 0 ? kMap : kPlanning);
  const bool moving = state.range(1) == 1;
  window.turn();
  window.viewport.render();
  for (auto _ : state) {
    window.turn();
    window.viewport.setMoving(moving);
    window.viewport.render();
  }
  countFaces(state);
  label(state);
}
BENCHMARK(orbitFrame)
    ->ArgNames({"planning", "moving"})
    ->Args({0, 1})
    ->Args({1, 1})
    ->Args({0, 0})
    ->Args({1, 0})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// From a loaded step to its picture: layers built and drawn for the first time.
void firstFrame(benchmark::State& state) {
  for (auto _ : state) Window window(kMap);
  label(state);
}
BENCHMARK(firstFrame)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// The picture of another step: every layer is another one.
void stepChange(benchmark::State& state) {
  Window window(kMap);
  const auto other = std::make_shared<StateGrid>(*tabletop().states);
  bool odd = false;
  for (auto _ : state) {
    odd = !odd;
    SceneFrame frame = tabletop().frame();
    if (odd) frame.map = other;
    window.scene.setFrame(frame);
    window.redraw();
  }
  label(state);
}
BENCHMARK(stepChange)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// The picture after the saliency changed (segments are coloured anew), or after views were ranked anew.
void changedPicture(benchmark::State& state) {
  Window window(kPlanning);
  const bool ranking = state.range(0) == 1;
  std::array<StepRecord, 2> records = {tabletop().record, tabletop().record};
  if (ranking)
    records[1].search = std::make_shared<ViewSearch>(*records[1].search);
  else
    records[1].saliency = std::make_shared<Saliency>(*records[1].saliency);
  std::size_t n = 0;
  for (auto _ : state) {
    n = 1 - n;
    const SceneFrame frame{tabletop().header, records[n], *tabletop().states, nullptr,
                           nullptr,           nullptr,    tabletop().states};
    window.scene.setFrame(frame);
    window.redraw();
  }
  label(state);
}
BENCHMARK(changedPicture)
    ->ArgName("ranking")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace vantage
