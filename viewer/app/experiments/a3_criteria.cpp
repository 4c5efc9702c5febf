#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/app/experiments/a3_runs.h"

namespace vantage::experiments {
namespace {

std::string seedsText(std::size_t seeds) {
  return fmt::format("{} seed{}", seeds, seeds == 1 ? "" : "s");
}

/// (1) Most views drawn at random miss the object.
Claim perViewClaim(const RateSet& set, const Yardstick& a1) {
  Claim claim{"A3 (1)",
              fmt::format("{}: evaluation per view below the mean of A1", set.name),
              "6.9 ms against 275 ms",
              "nothing was measured",
              Verdict::NotRun,
              ""};
  const RateRun& first = set.runs.front();
  claim.remark = fmt::format("{:.0f} candidates, {:.0f} of them traced; {}; {}; A1: {}", first.candidates,
                             first.scored, first.mode, seedsText(set.runs.size()), a1.source);
  const std::optional<Spread> ours = set.perView_ms();
  if (!ours) return claim;
  claim.ours = ours->text(3) + " ms";
  if (!a1.seconds_per_view) return claim;
  claim.ours += fmt::format(" against {:.3f} ms", 1e3 * *a1.seconds_per_view);
  claim.verdict = passIf(ours->mean < 1e3 * *a1.seconds_per_view);
  return claim;
}

/// (2) A run that was cut off before its seventh scan says nothing.
Claim fallsClaim(const RateSet& set) {
  constexpr std::size_t kScans = 7;
  const std::size_t scans = set.fewestScans();
  const bool falls = std::ranges::all_of(set.runs, &RateRun::unknownFalls);
  const bool too_short = std::ranges::any_of(
      set.runs, [](const RateRun& run) { return run.cut_off && run.unknown_per_scan.size() < kScans; });
  return {
      "A3 (2)",
      fmt::format("{}: unknown in the box falls over at least {} scans", set.name, kScans),
      "seven scans shown",
      scans < 2 ? "nothing was measured"
                : fmt::format("{} scans, {}", scans, falls ? "falls with each" : "does not fall with each"),
      scans < 2            ? Verdict::NotRun
      : falls && too_short ? Verdict::NotComparable
                           : passIf(falls && scans >= kScans),
      fmt::format("{}{}", set.runs.size() == 1 ? "one seed" : "every one of " + seedsText(set.runs.size()),
                  too_short ? "; cut off before the seventh scan" : "")};
}

/// (3) Fewer views than the paper's prove nothing about them.
Claim secondClaim(const RateSet& set) {
  constexpr double kViews = 1500;
  const double views = set.fewestCandidates();
  Claim claim{"A3 (3)",        fmt::format("{}: {:.0f} views evaluated in less than 1 s", set.name, kViews),
              "10.3 s",        "nothing was measured",
              Verdict::NotRun, "a target of ours; other hardware than the paper's"};
  if (!(views > 0)) return claim;
  const Spread evaluate = set.evaluate_s();
  claim.ours = fmt::format("{} s for {:.0f} views", evaluate.text(3), views);
  if (views >= kViews)
    claim.verdict = passIf(evaluate.mean < 1.0);
  else
    claim.remark = "fewer views were asked for (candidates.*)";
  return claim;
}

}  // namespace

Spread RateSet::spread(const std::function<double(const RateRun&)>& measure) const {
  std::vector<double> values;
  for (const RateRun& run : runs) values.push_back(measure(run));
  return spreadOf(values);
}

Spread RateSet::evaluate_s() const {
  return spread([](const RateRun& run) { return run.mean().evaluate; });
}

std::optional<Spread> RateSet::perView_ms() const {
  if (!std::ranges::all_of(runs, [](const RateRun& run) { return run.secondsPerView().has_value(); }))
    return std::nullopt;
  return spread([](const RateRun& run) { return 1e3 * run.secondsPerView().value(); });
}

std::size_t RateSet::fewestScans() const {
  std::size_t fewest = runs.front().unknown_per_scan.size();
  for (const RateRun& run : runs) fewest = std::min(fewest, run.unknown_per_scan.size());
  return fewest;
}

double RateSet::fewestCandidates() const {
  double fewest = runs.front().candidates;
  for (const RateRun& run : runs) fewest = std::min(fewest, run.candidates);
  return fewest;
}

void judgeRates(const RateSet& set, const Yardstick& a1, Report& report) {
  report.claims.push_back(perViewClaim(set, a1));
  report.claims.push_back(fallsClaim(set));
  report.claims.push_back(secondClaim(set));
}

}  // namespace vantage::experiments
