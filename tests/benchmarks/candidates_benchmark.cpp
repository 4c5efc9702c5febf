#include <benchmark/benchmark.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <random>

#include "viewer/candidate_table.h"
#include "viewer/explanation.h"

// The table of candidate views: 31 200 poses in twelve segments, as many as the embedded scene `tabletop` has
// in its first step.

namespace vantage {
namespace {

constexpr int kSegments = 12, kPosesEach = 2600;

StepData makeStep() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> gain(0.0, 40000.0);
  auto header = std::make_shared<RunHeader>();
  auto record = std::make_shared<StepRecord>();
  auto search = std::make_shared<ViewSearch>();
  std::uint32_t id = 0;
  for (int g = 0; g < kSegments; ++g) {
    SegmentSearch& group = search->segments.emplace_back();
    group.scored = true;
    for (int n = 0; n < kPosesEach; ++n) group.scores.push_back({.id = id++, .gain = gain(random)});
    std::ranges::stable_sort(group.scores, std::greater<>(), &PoseScore::gain);
  }
  const std::size_t rolls = header->contour_config.views.rolls;
  record->positions = std::make_shared<std::vector<ViewPosition>>(id / rolls);
  record->search = std::move(search);
  StepData step;
  step.header = std::move(header);
  step.record = std::move(record);
  step.states = std::make_shared<StateGrid>();
  return step;
}

/// Another decision about the same candidates arrives: rows, changes of rank, sorting.
void BM_ShowAnotherDecision(benchmark::State& state) {
  const StepData recorded = makeStep();
  StepData shown = recorded;
  CandidateTable table;
  for (auto _ : state) {
    state.PauseTiming();
    auto header = std::make_shared<RunHeader>(*recorded.header);
    header->contour_config.gain.gain_threshold = 5000.0;
    shown.header = std::move(header);
    state.ResumeTiming();
    table.show(recorded, shown);
    benchmark::DoNotOptimize(table.listed().size());
  }
}
BENCHMARK(BM_ShowAnotherDecision)->Unit(benchmark::kMillisecond);

void BM_SortByGain(benchmark::State& state) {
  const std::vector<CandidateRow> rows = candidateRows(makeStep().frame());
  for (auto _ : state) benchmark::DoNotOptimize(listedRows(rows, {}, CandidateColumn::Gain, true));
}
BENCHMARK(BM_SortByGain)->Unit(benchmark::kMillisecond);

/// Once a frame, whatever is selected.
void BM_Explain(benchmark::State& state) {
  const StepData step = makeStep();
  const std::vector<CandidateRow> rows = candidateRows(step.frame());
  for (auto _ : state) benchmark::DoNotOptimize(explain(step.frame(), rows, rows.back().id));
}
BENCHMARK(BM_Explain)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vantage
