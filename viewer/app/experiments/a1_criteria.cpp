#include <fmt/format.h>

#include <algorithm>

#include "viewer/app/experiments/a1_runs.h"

namespace vantage::experiments {
namespace {

/// Largest of a measure over runs, and where.
struct Worst {
  std::optional<double> value;
  std::string where;
  int measured = 0, unmeasured = 0;  ///< runs

  void take(const std::optional<double>& candidate, const ObjectRuns& set, const RunResult& run) {
    ++(candidate ? measured : unmeasured);
    if (!candidate || (value && *candidate <= *value)) return;
    value = candidate;
    where = set.title() + " " + run.spec.label();
  }
  std::string text(int decimals) const {
    return value ? fmt::format("{:.{}f} % ({})", 100 * *value, decimals, where) : "nothing was measured";
  }
  /// \param limit a share
  Verdict verdict(double limit) const { return value ? passIf(*value <= limit) : Verdict::NotRun; }
  std::string remark(const std::string& words) const {
    return words + (unmeasured ? fmt::format("; {} gave nothing to compare", runsText(unmeasured)) : "");
  }
};

template <class Wanted, class Measure>
Worst worst(const std::vector<ObjectRuns>& sets, const Wanted& wanted, const Measure& measure) {
  Worst result;
  for (const ObjectRuns& set : sets)
    for (const RunResult& run : set.runs)
      if (wanted(run.spec)) result.take(measure(set, run), set, run);
  return result;
}

bool resumes(const RunSpec& spec, int least) {
  return spec.graded() && spec.coarse_levels >= least && spec.start == ChildStart::Resume;
}

}  // namespace

void judgeCost(const std::vector<ObjectRuns>& sets, Report& report) {
  const auto usual = [](const RunSpec& s) { return resumes(s, 2); };
  const auto coarse = [](const RunSpec& s) { return resumes(s, 3); };
  const auto restarts = [](const RunSpec& s) {
    return s.graded() && s.coarse_levels >= 3 && s.start == ChildStart::Restart;
  };
  const Worst time = worst(sets, usual, timeShare);
  report.claims.push_back({"A1 (1)", "NBV time per iteration, m >= 2, resume: at most 10 % of uniform",
                           "> 90 % less (dragon 4.2 %)", time.text(1), time.verdict(0.10),
                           time.remark("largest of " + runsText(time.measured))});
  const Worst cpu = worst(sets, usual, cpuShare);
  report.claims.push_back({"A1 CPU", "the same in CPU time of all threads", "-", cpu.text(1),
                           cpu.value ? Verdict::NotComparable : Verdict::NotRun,
                           cpu.remark("beside (1): other programs on the machine disturb it less")});
  const Worst visits = worst(sets, usual, visitShare);
  report.claims.push_back({"A1 visits", "the same in voxels visited per view", "-", visits.text(2),
                           visits.verdict(0.10), visits.remark("does not depend on the machine")});
  const Worst hidden = worst(sets, coarse, hiddenTimeShare);
  report.claims.push_back({"A1 (2)", "views hidden by the table, m >= 3: at most 3 % of uniform",
                           "0.05 s against 5.6 s: 0.9 %", hidden.text(2), hidden.verdict(0.03),
                           hidden.remark("time on the map after the first scan, resume")});
  const Worst restart = worst(sets, restarts, hiddenVisitShare);
  if (restart.value)
    report.claims.push_back({"A1 (2)", "the same with restart, in visits", "-", restart.text(2),
                             Verdict::NotComparable, restart.remark("printed, not graded")});
}

void judgeSameness(const std::vector<ObjectRuns>& sets, Report& report) {
  std::uint64_t different = 0, compared = 0, wrong = 0, labels = 0;
  int steps = 0;
  for (const ObjectRuns& set : sets)
    for (const RunResult& run : set.runs) {
      different += run.different_from_uniform;
      compared += run.compared_with_uniform;
      wrong += run.wrong_labels;
      labels += run.compared_labels;
      steps += run.compared_steps;
    }
  report.claims.push_back(
      {"A1 (5)", "m = 0 equals uniform ray tracing", "-",
       compared > 0 ? fmt::format("{} of {} views differ", different, compared) : "nothing was compared",
       compared > 0 ? passIf(different == 0) : Verdict::NotRun,
       "all counts of every view of every step, hence the same sequence of views"});
  report.claims.push_back({"A1 map", "state grids equal the octree at every level", "-",
                           labels > 0
                               ? fmt::format("{} of {} nodes differ, at {} steps", wrong, labels, steps)
                               : "nothing was compared",
                           labels > 0 ? passIf(wrong == 0) : Verdict::NotRun,
                           "in the object's box, at steps 1, 11, ... of every run"});
}

void judgeRuns(const std::vector<ObjectRuns>& sets, Report& report) {
  judgeCost(sets, report);
  judgeEnds(sets, report);
  judgeSameness(sets, report);
}

}  // namespace vantage::experiments
