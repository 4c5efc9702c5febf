// Criteria (3) and (4) of A1, which compare what runs ended with. A run that was cut off would have gone on:
// its views, its time and (but for a few voxels that later scans free again) its coverage are least values.

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "viewer/app/experiments/a1_runs.h"

namespace vantage::experiments {
namespace {

/// What a comparison of two runs says of the one that they would have ended with.
enum class Bound { Exact, AtLeast, AtMost, None };

/// A run against uniform ray tracing.
struct Comparison {
  double value = 0.0;
  Bound bound = Bound::Exact;
  std::string where;

  /// Verdict for a limit from above; empty if the runs did not go far enough to tell.
  std::optional<bool> meets(double limit) const {
    const bool met = value <= limit;
    if (bound == Bound::Exact || (bound == Bound::AtMost && met) || (bound == Bound::AtLeast && !met))
      return met;
    return std::nullopt;
  }
};

/// How a value grows with further steps.
enum class Grows { WithTheRun, WithUniform };

Bound boundOf(const RunResult& run, const RunResult& uniform, Grows grows) {
  if (!run.cut_off && !uniform.cut_off) return Bound::Exact;
  if (run.cut_off && uniform.cut_off) return Bound::None;
  return run.cut_off == (grows == Grows::WithTheRun) ? Bound::AtLeast : Bound::AtMost;
}

/// One criterion: a measure that must stay below a limit.
struct Criterion {
  std::string number, claim, paper, runs;
  std::optional<double> (*measure)(const ObjectRuns&, const RunResult&);
  Grows grows;
  double limit;
  std::string (*text)(double);
  bool negated = false;  ///< the text shows the value with the other sign
};

template <class Wanted>
std::vector<Comparison> compare(const std::vector<ObjectRuns>& sets, const Wanted& wanted,
                                const Criterion& criterion, int& unmeasured) {
  std::vector<Comparison> all;
  for (const ObjectRuns& set : sets)
    for (const RunResult& run : set.runs) {
      if (!wanted(run.spec)) continue;
      if (const auto value = criterion.measure(set, run))
        all.push_back(
            {*value, boundOf(run, set.uniform(), criterion.grows), set.title() + " " + run.spec.label()});
      else
        ++unmeasured;
    }
  return all;
}

/// The comparison that decides the criterion: the worst of those that can be graded, misses first; of none,
/// the worst.
const Comparison* decisive(const std::vector<Comparison>& all, double limit) {
  const Comparison* found = nullptr;
  const auto rank = [&](const Comparison& c) {
    const std::optional<bool> met = c.meets(limit);
    return std::pair(!met ? 0 : *met ? 1 : 2, c.value);
  };
  for (const Comparison& c : all)
    if (!found || rank(c) > rank(*found)) found = &c;
  return found;
}

std::string boundedText(const Comparison& c, const Criterion& criterion) {
  const std::string text = criterion.text(c.value);
  if (c.bound == Bound::Exact || c.bound == Bound::None) return text;
  const bool at_least = (c.bound == Bound::AtLeast) != criterion.negated;
  return (at_least ? "in the end >= " : "in the end <= ") + text;
}

template <class Wanted>
void judge(const std::vector<ObjectRuns>& sets, const Wanted& wanted, const Criterion& criterion,
           Report& report) {
  int unmeasured = 0, graded = 0;
  const std::vector<Comparison> all = compare(sets, wanted, criterion, unmeasured);
  std::string open;
  for (const Comparison& c : all)
    if (c.meets(criterion.limit))
      ++graded;
    else
      open += (open.empty() ? "" : ", ") + c.where + ": " + criterion.text(c.value);

  Claim claim{"A1 " + criterion.number,
              criterion.claim,
              criterion.paper,
              "nothing was measured",
              Verdict::NotRun,
              graded > 0 ? "worst of " + runsText(graded) + ", " + criterion.runs
                         : "no run can be graded, " + criterion.runs};
  if (const Comparison* worst = decisive(all, criterion.limit)) {
    const std::optional<bool> met = worst->meets(criterion.limit);
    claim.ours = boundedText(*worst, criterion) + " (" + worst->where + ")";
    claim.verdict = met ? passIf(*met) : Verdict::NotComparable;
  }
  if (!open.empty()) claim.remark += "; not comparable, cut off before they ended: " + open;
  if (unmeasured > 0) claim.remark += fmt::format("; {} gave nothing to compare", runsText(unmeasured));
  report.claims.push_back(std::move(claim));
}

std::string points(double lost) {
  return fmt::format("{:+.1f} points", lost == 0.0 ? 0.0 : -lost);
}
std::string times(double share) {
  return fmt::format("{:.3g}", share);
}

}  // namespace

void judgeEnds(const std::vector<ObjectRuns>& sets, Report& report) {
  const auto all = [](const RunSpec& s) { return s.coarse_levels > 0 && s.graded(); };
  const auto usual = [](const RunSpec& s) { return s.coarse_levels == 2 && s.graded(); };
  const double below_one = std::nextafter(1.0, 0.0);
  const Criterion coverage{"(3)",      "final coverage at most 2 points below uniform",
                           "-",        "all modes",
                           lostPoints, Grows::WithUniform,
                           2.0,        points,
                           true};
  Criterion usual_coverage = coverage;
  usual_coverage.number = "(3) m=2";
  usual_coverage.claim = "the same for the default m = 2";
  usual_coverage.runs = "resume and restart";
  judge(sets, all, coverage, report);
  judge(sets, usual, usual_coverage, report);
  judge(sets, all,
        Criterion{"(4a)", "at most 1.6 times the views of uniform", "1.5 (10 to 15)", "all modes", viewShare,
                  Grows::WithTheRun, 1.6, times},
        report);
  judge(sets, all,
        Criterion{"(4b)", "less total planning time than uniform", "1320 s against 20 750 s: 0.064",
                  "all modes", totalTimeShare, Grows::WithTheRun, below_one, times},
        report);
}

}  // namespace vantage::experiments
