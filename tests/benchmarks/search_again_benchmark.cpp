#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <chrono>

#include "core/exploration/plan_view.h"
#include "core/exploration/replan.h"
#include "core/planners/search_again.h"
#include "tests/benchmarks/tabletop_map.h"

// What a moving slider costs: the views of a step on the embedded scene `tabletop` ranked again under another
// B_th, gain threshold or sphere margin, on one thread, and how many times longer a fresh search takes.

namespace vantage {
namespace {

/// A planned step with the scores of all its groups.
struct ScoredStep {
  const benchmarks::TabletopMap& map = benchmarks::tabletopMap();
  ContourPlannerConfig config = map.settings.exploration.contour;
  StepRecord record;
  Saliency saliency;  ///< the recorded one; its segments change
  ReachPose reach;
  std::optional<ScoredGroups> groups;

  ScoredStep() {
    reach = quickReach(
        {.planner = map.motion, .exploration = map.settings.exploration, .step = 1, .start = {}, .left = {}},
        {});
    planView(record,
             {.volume = map.volume,
              .states = map.states,
              .camera = map.settings.camera,
              .workspace = map.settings.exploration.workspace,
              .config = config},
             reach, [](Stage) {}, {});
    saliency = *record.saliency;
    groups.emplace(*record.search, config);
    for (const std::uint32_t s : groups->pendingIn(*record.search))
      groups->add(scoreGroup(input(), config, record.search->segments[s], {}));
  }

  ViewSearchInput input() const {
    return {.states = map.states,
            .camera = map.settings.camera,
            .workspace = map.settings.exploration.workspace,
            .points = record.contours->points,
            .positions = *record.positions,
            .point_labels = *record.point_labels,
            .saliency = saliency,
            .executed = {},
            .disappointing = {}};
  }
};

ScoredStep& scoredStep() {
  static ScoredStep step;
  return step;
}

enum Change { IsolationDistance, Threshold, Margin, MarginOfAll };
constexpr const char* kNames[] = {"B_th", "threshold", "margin", "margin, no view above the threshold"};

/// The n-th position of the slider.
ContourPlannerConfig moved(const ContourPlannerConfig& config, Change change, int n) {
  ContourPlannerConfig wanted = config;
  const int k = n % 40 + 1;
  if (change == IsolationDistance) wanted.saliency.isolation_distance_m = 0.0025 * k;
  if (change == Threshold) wanted.gain.gain_threshold = 100.0 * k;
  if (change == Margin || change == MarginOfAll) wanted.gain.sphere_margin_m = 0.01 * k;
  if (change == MarginOfAll) wanted.gain.gain_threshold = 1e9;
  return wanted;
}

double freshSearch_ms(ScoredStep& step, const ContourPlannerConfig& config) {
  step.saliency.segments = rescoreSegments(*step.record.saliency, *step.record.labels, config.saliency);
  const auto start = std::chrono::steady_clock::now();
  benchmark::DoNotOptimize(searchView(step.input(), config, step.reach, {}));
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void rankAgain(benchmark::State& state) {
  ScoredStep& step = scoredStep();
  const auto change = static_cast<Change>(state.range(0));
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  int n = 0;
  double again_ms = 0.0, reached = 0.0;
  for (auto _ : state) {
    const ContourPlannerConfig wanted = moved(step.config, change, n);
    const auto start = std::chrono::steady_clock::now();
    step.saliency.segments = rescoreSegments(*step.record.saliency, *step.record.labels, wanted.saliency);
    const SearchAgain found = searchAgain(step.input(), wanted, *step.groups, step.reach);
    again_ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    reached += static_cast<double>(found.search.counts.poses_scored);
    ++n;
  }
  const double fresh_ms = freshSearch_ms(step, moved(step.config, change, 20));
  state.SetLabel(std::string("tabletop, ") + kNames[change] + ", 1 thread");
  state.counters["poses"] = static_cast<double>(step.record.search->counts.poses_generated);
  state.counters["reached"] = reached / n;
  state.counters["groups"] = static_cast<double>(step.record.search->segments.size());
  state.counters["points"] = static_cast<double>(step.record.surface->points.size());
  state.counters["fresh_ms"] = fresh_ms;
  state.counters["ratio"] = fresh_ms * n / again_ms;
}
BENCHMARK(rankAgain)
    ->ArgName("change")
    ->DenseRange(IsolationDistance, MarginOfAll)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vantage
