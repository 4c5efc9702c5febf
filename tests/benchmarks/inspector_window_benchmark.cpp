#include <memory>

#include "tests/benchmarks/inspector_window.h"

// The inspector's whole window, panels and all, driven by the mouse without a display on recorded runs of
// `tabletop`. Times are from the event to the end of the frame that shows what it asked for.

namespace vantage {
namespace {

using benchmarks::InspectorWindow;
using Clock = std::chrono::steady_clock;

const LayerSet kMap = {Layer::Workspace, Layer::Axes, Layer::Occupied, Layer::Unknown};

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Times what is wanted of each iteration, and the processor time of all threads meanwhile.
class Stopwatch {
 public:
  explicit Stopwatch(benchmark::State& state) : state_(state) {}
  void start() {
    cpu_s_ = benchmarks::cpuSeconds();
    start_ = Clock::now();
  }
  void stop() {
    state_.SetIterationTime(secondsSince(start_));
    used_s_ += benchmarks::cpuSeconds() - cpu_s_;
  }
  ~Stopwatch() { state_.counters["cpu_ms"] = 1e3 * used_s_ / static_cast<double>(state_.iterations()); }

 private:
  benchmark::State& state_;
  Clock::time_point start_;
  double cpu_s_ = 0.0, used_s_ = 0.0;
};

Preferences showing(const LayerSet& layers) {
  Preferences preferences;
  preferences.view.layers = layers;
  return preferences;
}

/// From the file's name to the first picture of its first step; the window is there.
void openRun(benchmark::State& state) {
  const auto file = benchmarks::tenSteps();
  double settled_s = 0.0;
  std::unique_ptr<InspectorWindow> window;
  Stopwatch watch(state);
  for (auto _ : state) {
    window.reset();
    window = std::make_unique<InspectorWindow>();
    const auto start = Clock::now();
    watch.start();
    window->inspector.open({file});
    window->untilPicture();
    watch.stop();
    window->until([&] { return window->inspector.pictureIsFull(); });
    settled_s += secondsSince(start);
  }
  window->describe(state);
  state.counters["full_picture_ms"] = 1e3 * settled_s / static_cast<double>(state.iterations());
}
BENCHMARK(openRun)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(3);

enum Change { Next, Previous, FarAway };

/// From the button's release to the first picture of another step: the next one, which was read ahead; the
/// one before, which was not; one from the other end of the run.
void stepChange(benchmark::State& state) {
  InspectorWindow window;
  window.open(benchmarks::tenSteps());
  const auto change = static_cast<Change>(state.range(0));
  if (change == Previous) window.model().goToStep(9);
  bool back = false;
  Stopwatch watch(state);
  for (auto _ : state) {
    window.ui.settle(300.0);
    window.ui.hover(change == Next       ? "timeline/next"
                    : change == Previous ? "timeline/previous"
                    : back               ? "timeline/step 1"
                                         : "timeline/step 10");
    back = !back;
    window.ui.pressMouse();
    watch.start();
    window.ui.releaseMouse();
    window.untilPicture();
    watch.stop();
  }
  window.describe(state);
}
BENCHMARK(stepChange)
    ->ArgName("next_previous_far")
    ->Arg(Next)
    ->Arg(Previous)
    ->Arg(FarAway)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(4);

/// A frame of the window while the mouse drags the scene around, and one in which nothing changes.
void turnFrame(benchmark::State& state, const std::vector<std::string>& assignments, const LayerSet& layers,
               bool turning) {
  InspectorWindow window(showing(layers));
  window.open(benchmarks::recordedTabletop(assignments));
  window.ui.hover("view");
  const WidgetBox view = *window.inspector.widgets().find("view");
  const double y = view.top + 0.15 * (view.bottom - view.top);
  double x = view.left + 0.3 * (view.right - view.left);
  if (turning) {
    window.ui.moveMouse(x, y);
    window.ui.pressMouse();
    window.ui.moveMouse(x += 4.0, y);
  }
  const std::uint64_t before = window.inspector.picturesRendered();
  for (auto _ : state) {
    if (turning) window.ui.moveMouse(x += 4.0, y);
    if (!turning) window.ui.frame();
  }
  window.describe(state);
  state.counters["pictures"] = benchmark::Counter(
      static_cast<double>(window.inspector.picturesRendered() - before), benchmark::Counter::kAvgIterations);
  window.ui.releaseMouse();
}
const std::vector<std::string> kTenSteps = {"exploration.steps=10"},
                               kFine = {"exploration.steps=1", "volume.voxel_size_m=0.0055",
                                        "volume.size=[546,363,213]"};
BENCHMARK_CAPTURE(turnFrame, overview, kTenSteps, {}, true)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(turnFrame, map, kTenSteps, kMap, true)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(turnFrame, map_of_finer_voxels, kFine, kMap, true)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(turnFrame, panels_alone, kTenSteps, {}, false)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// From a movement of the mouse on the slider of B_th to the picture of the new ranking, and on to the one of
/// the view whose path has been planned.
void dragIsolationDistance(benchmark::State& state) {
  InspectorWindow window;
  window.open(benchmarks::tenSteps());
  const std::string slider = "what-if/saliency.isolation_distance_m";
  window.ui.click("tab/What if");
  window.ui.hover(slider);
  const WidgetBox box = *window.inspector.widgets().find(slider);
  const auto at = [&](double share) { return box.left + share * (box.right - box.left); };
  window.ui.moveMouse(at(0.5), box.y());
  window.ui.pressMouse();
  double rerank_s = 0.0, settled_s = 0.0;
  int turn = 0;
  Stopwatch watch(state);
  for (auto _ : state) {
    window.ui.settle(300.0);
    ++turn;
    const WhatIf& what_if = window.model().whatIf();
    const std::uint64_t decision = what_if.revision(), before = window.inspector.picturesRendered();
    const auto start = Clock::now();
    watch.start();
    window.ui.moveMouse(at(0.3 + 0.02 * (turn % 20)), box.y());
    while (what_if.revision() == decision || window.inspector.picturesRendered() == before) window.ui.frame();
    watch.stop();
    const bool ranked = what_if.state() == WhatIfState::Checking || what_if.state() == WhatIfState::Settled;
    if (!ranked) state.SkipWithError("views had to be scored first");
    window.until([&] { return what_if.state() == WhatIfState::Settled; });
    settled_s += secondsSince(start);
    rerank_s += what_if.rerankSeconds();
  }
  window.ui.releaseMouse();
  window.describe(state);
  state.counters["rerank_ms"] = 1e3 * rerank_s / static_cast<double>(state.iterations());
  state.counters["settled_ms"] = 1e3 * settled_s / static_cast<double>(state.iterations());
  state.counters["groups"] = static_cast<double>(window.model().whatIf().groups());
}
BENCHMARK(dragIsolationDistance)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(8);

/// Five seconds of a window that nobody touches, as its loop spends them.
void idleWindow(benchmark::State& state) {
  constexpr double kWatched_s = 5.0, kPoll_s = 0.1;
  InspectorWindow window;
  window.open(benchmarks::tenSteps());
  window.until([&] { return window.inspector.idle(); });
  double used_s = 0.0;
  const std::uint64_t before = window.inspector.picturesRendered();
  for (auto _ : state) {
    const double cpu_s = benchmarks::cpuSeconds();
    const auto start = Clock::now();
    while (secondsSince(start) < kWatched_s) {
      std::this_thread::sleep_for(std::chrono::duration<double>(kPoll_s));
      if (window.inspector.update(kPoll_s)) window.ui.frame(kPoll_s);
    }
    used_s += benchmarks::cpuSeconds() - cpu_s;
  }
  window.describe(state);
  state.counters["core_percent"] = 100.0 * used_s / (kWatched_s * static_cast<double>(state.iterations()));
  state.counters["pictures"] = static_cast<double>(window.inspector.picturesRendered() - before);
}
BENCHMARK(idleWindow)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime()->Iterations(1);

/// Memory while a run of ten steps is stepped through, played through stage by stage, and segmented anew at
/// its last step.
void tenStepsInMemory(benchmark::State& state) {
  constexpr double kMiB = 1024.0 * 1024.0;
  const auto file = benchmarks::tenSteps();
  benchmarks::forgetPeakMemory();
  const double before = benchmarks::peakMemory();
  for (auto _ : state) {
    InspectorWindow window;
    window.open(file);
    for (std::size_t i = 1; i < window.model().steps().size(); ++i) {
      window.ui.click("timeline/next");
      window.ui.settle(300.0);
    }
    window.ui.click("timeline/first");
    window.ui.settle(300.0);
    window.model().player.setSpeed(4.0);
    window.ui.click("timeline/by stage");
    window.ui.click("timeline/play");
    window.until([&] { return !window.model().player.playing(); });
    window.ui.click("timeline/step 10");
    window.ui.settle(300.0);
    window.ui.click("tab/What if");
    window.ui.click("what-if/group Segmentation");
    window.ui.enter("what-if/segmentation.seed_m/text", "80");
    window.ui.settle(300.0);
    window.describe(state);
    state.counters["settled"] = window.model().whatIf().state() == WhatIfState::Settled;
  }
  state.counters["peak_MiB"] = benchmarks::peakMemory() / kMiB;
  state.counters["before_MiB"] = before / kMiB;
}
BENCHMARK(tenStepsInMemory)->Unit(benchmark::kSecond)->UseRealTime()->Iterations(1);

}  // namespace
}  // namespace vantage
