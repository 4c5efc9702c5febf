#include <fmt/format.h>

#include <algorithm>

#include "viewer/app/experiments/a1_runs.h"

namespace vantage::experiments {
namespace {

/// Largest of a measure over runs, and where.
struct Worst {
  double value = -1e300;
  std::string where;
  int runs = 0;
  void take(double candidate, const ObjectRuns& set, const RunResult& run) {
    ++runs;
    if (candidate <= value) return;
    value = candidate;
    where = set.title() + " " + run.spec.label();
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

std::size_t longest(const std::vector<ObjectRuns>& sets) {
  std::size_t steps = 0;
  for (const ObjectRuns& set : sets)
    for (const RunResult& run : set.runs) steps = std::max(steps, run.iterations.size());
  return steps;
}

bool hierarchical(const RunSpec& spec) {
  return spec.coarse_levels > 0 && spec.graded();
}
bool resumes(const RunSpec& spec, int least) {
  return hierarchical(spec) && spec.coarse_levels >= least && spec.start == ChildStart::Resume;
}

Claim claim(const std::string& number, const std::string& what, const std::string& paper, const Worst& found,
            const std::string& value, bool met, const std::string& remark) {
  return {"A1 " + number,
          what,
          paper,
          value + (found.where.empty() ? "" : " (" + found.where + ")"),
          found.runs > 0 ? passIf(met) : Verdict::NotRun,
          remark};
}

/// Criteria (1) and (2): cost.
void judgeCost(const std::vector<ObjectRuns>& sets, Report& report) {
  const Worst time = worst(
      sets, [](const RunSpec& s) { return resumes(s, 2); }, timeShare);
  report.claims.push_back(claim("(1)", "NBV time per iteration, m >= 2, resume: at most 10 % of uniform",
                                "> 90 % less (dragon 4.2 %)", time, fmt::format("{:.1f} %", 100 * time.value),
                                time.value <= 0.10, fmt::format("largest of {} runs", time.runs)));
  const Worst cpu = worst(
      sets, [](const RunSpec& s) { return resumes(s, 2); }, cpuShare);
  report.claims.push_back({"A1 CPU", "the same in CPU time of all threads", "-",
                           fmt::format("{:.1f} % ({})", 100 * cpu.value, cpu.where), Verdict::NotComparable,
                           "beside (1): other programs on the machine disturb it less"});
  const Worst visits = worst(
      sets, [](const RunSpec& s) { return resumes(s, 2); }, visitShare);
  report.claims.push_back(claim("visits", "the same in voxels visited per view", "-", visits,
                                fmt::format("{:.2f} %", 100 * visits.value), visits.value <= 0.10,
                                "does not depend on the machine"));
  const Worst hidden = worst(
      sets, [](const RunSpec& s) { return resumes(s, 3); }, hiddenTimeShare);
  report.claims.push_back(claim("(2)", "views hidden by the table, m >= 3: at most 3 % of uniform",
                                "0.05 s against 5.6 s: 0.9 %", hidden,
                                fmt::format("{:.2f} %", 100 * hidden.value), hidden.value <= 0.03,
                                "time on the map after the first scan, resume"));
  const Worst restart = worst(
      sets,
      [](const RunSpec& s) { return s.graded() && s.coarse_levels >= 3 && s.start == ChildStart::Restart; },
      hiddenVisitShare);
  if (restart.runs > 0)
    report.claims.push_back({"A1 (2)", "the same with restart, in visits", "-",
                             fmt::format("{:.2f} % ({})", 100 * restart.value, restart.where),
                             Verdict::NotComparable, "printed, not graded"});
}

double lostPoints(const ObjectRuns& set, const RunResult& run) {
  return 100 * (set.uniform().coverage - run.coverage);
}

/// Criterion (3): quality.
void judgeCoverage(const std::vector<ObjectRuns>& sets, Report& report) {
  const auto judged = [&](const std::string& number, const std::string& what, const Worst& lost,
                          const std::string& which) {
    report.claims.push_back(
        claim(number, what, "-", lost, fmt::format("{:+.1f} points", -lost.value), lost.value <= 2.0,
              fmt::format("lowest of {} runs, {}; at most {} steps", lost.runs, which, longest(sets))));
  };
  judged("(3)", "final coverage at most 2 points below uniform", worst(sets, hierarchical, lostPoints),
         "all modes");
  const auto usual = [](const RunSpec& s) { return s.graded() && s.coarse_levels == 2; };
  judged("(3) m=2", "the same for the default m = 2", worst(sets, usual, lostPoints), "resume and restart");
}

/// Criterion (4): views and total time.
void judgeViews(const std::vector<ObjectRuns>& sets, Report& report) {
  const Worst views = worst(sets, hierarchical, [](const ObjectRuns& set, const RunResult& run) {
    return ratio(run.scans, set.uniform().scans);
  });
  report.claims.push_back(claim("(4a)", "at most 1.6 times the views of uniform", "1.5 (10 to 15)", views,
                                fmt::format("{:.2f}", views.value), views.value <= 1.6,
                                fmt::format("largest of {} runs, all modes", views.runs)));
  const Worst total = worst(sets, hierarchical, [](const ObjectRuns& set, const RunResult& run) {
    return ratio(run.totalNbv_s(), set.uniform().totalNbv_s());
  });
  report.claims.push_back(claim("(4b)", "less total planning time than uniform",
                                "1320 s against 20 750 s: 0.064", total, fmt::format("{:.3f}", total.value),
                                total.value < 1.0,
                                fmt::format("largest share of {} runs, all modes", total.runs)));
}

/// Criterion (5) and what keeps the maps honest.
void judgeSameness(const std::vector<ObjectRuns>& sets, Report& report) {
  std::uint64_t different = 0, compared = 0, wrong = 0;
  for (const ObjectRuns& set : sets)
    for (const RunResult& run : set.runs) {
      different += run.different_from_uniform;
      compared += run.compared_with_uniform;
      wrong += run.wrong_labels;
    }
  report.claims.push_back({"A1 (5)", "m = 0 equals uniform ray tracing", "-",
                           fmt::format("{} of {} views differ", different, compared),
                           compared > 0 ? passIf(different == 0) : Verdict::NotRun,
                           "all counts of every view of every step, hence the same sequence of views"});
  report.claims.push_back({"A1 map", "state grids equal the octree at every level", "-",
                           fmt::format("{} nodes differ", wrong), passIf(wrong == 0),
                           "in the object's box, every tenth step"});
}

}  // namespace

void judgeRuns(const std::vector<ObjectRuns>& sets, bool cut_off, Report& report) {
  judgeCost(sets, report);
  const std::size_t first = report.claims.size();
  judgeCoverage(sets, report);
  judgeViews(sets, report);
  for (std::size_t n = first; cut_off && n < report.claims.size(); ++n) {
    report.claims[n].verdict = Verdict::NotComparable;
    report.claims[n].remark += "; quick: the runs are cut off before they end";
  }
  judgeSameness(sets, report);
}

}  // namespace vantage::experiments
