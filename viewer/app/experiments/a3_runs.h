#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "viewer/app/experiments/experiments.h"
#include "viewer/app/experiments/spread.h"

namespace vantage::experiments {

/// Wall-clock seconds of one step's phases. The evaluation is the median of several; a scan, an update and a
/// path are measured once, since a scan and an update change what the next one would find.
struct Phases {
  double scan = 0, update = 0, evaluate = 0, path = 0;
  double total() const { return scan + update + evaluate + path; }
};

/// One run of the loop with views drawn in the workspace.
struct RateRun {
  std::string mode;  ///< as RunSpec::label()
  std::vector<Phases> steps;
  std::vector<double> unknown_per_scan;
  double candidates = 0, scored = 0, rejected_position = 0, rejected_registration = 0;  ///< means per step
  std::string stop_reason;
  bool cut_off = false;  ///< its steps were used up

  Phases mean() const;
  /// Seconds of a candidate; none if no ray was cast for any.
  std::optional<double> secondsPerView() const;
  /// Every scan leaves less unknown than the one before.
  bool unknownFalls() const;
};

/// The runs of one input with different seeds of the candidates; not empty.
struct RateSet {
  std::string name;
  std::vector<RateRun> runs;

  Spread spread(const std::function<double(const RateRun&)>& measure) const;
  Spread evaluate_s() const;
  /// None if some run evaluated nothing.
  std::optional<Spread> perView_ms() const;
  std::size_t fewestScans() const;
  double fewestCandidates() const;
};

/// What the time of a view in A3 is compared with.
struct Yardstick {
  std::optional<double> seconds_per_view;
  std::string source;  ///< where the number comes from
};

/// (a) A furnished room. \param used gets the defaults of the run
RateRun runRoom(const ExperimentOptions& options, std::uint64_t seed, std::vector<DefaultUsed>& used);
/// (b) The recorded sequence of the options: the chosen view is served by the nearest frame left.
RateRun runReplay(const ExperimentOptions& options, std::uint64_t seed, std::vector<DefaultUsed>& used);

/// Adds the claims about one input. What was not measured is "not run".
void judgeRates(const RateSet& set, const Yardstick& a1, Report& report);

}  // namespace vantage::experiments
