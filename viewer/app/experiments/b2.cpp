// B2: what each part of the contour-based planner is worth, one changed at a time (evaluation.md, section 4).
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "viewer/app/experiments/b1_report.h"
#include "viewer/app/experiments/b1_segments.h"
#include "viewer/app/experiments/b2_noise.h"
#include "viewer/app/experiments/b2_normals.h"
#include "viewer/app/experiments/b2_pictures.h"
#include "viewer/app/experiments/experiments.h"

namespace vantage::experiments {
namespace {

struct Variant {
  const char* part;  ///< of evaluation.md: "(b)"
  const char* name;
  std::vector<std::string> settings;
};

const std::vector<Variant>& variants() {
  static const std::vector<Variant> all = {
      {"-", "as it is", {}},
      {"(a)", "surface normal (view B)", {"contours.normal=surface"}},
      {"(b)", "saliency by roundness only", {"saliency.use_isolation=false"}},
      {"(b)", "saliency by isolation only", {"saliency.use_roundness=false"}},
      {"(c)", "B_th 0.005 m", {"saliency.isolation_distance_m=0.005"}},
      {"(c)", "B_th 0.01 m", {"saliency.isolation_distance_m=0.01"}},
      {"(c)", "B_th 0.05 m", {"saliency.isolation_distance_m=0.05"}},
      {"(c)", "B_th 0.1 m", {"saliency.isolation_distance_m=0.1"}},
      {"(d)", "transparent unknown outside the sphere", {"gain.outside=transparent"}},
      {"(d)", "gain at full resolution", {"gain.reduction=1"}},
      // 100 voxels are the faces that 700 rays meet at 0.8 m; behind each lie 34 of the sphere's margin.
      {"(d)", "gain in voxels", {"gain.count=voxels", "gain.reduction=2", "gain.threshold=100"}},
      {"(d)", "gain in volume", {"gain.count=volume", "gain.reduction=4", "gain.threshold=3400"}},
      {"(e)", "D_th x 0.5", {"contours.group_distance_m=0.01"}},
      {"(e)", "D_th x 2", {"contours.group_distance_m=0.04"}},
      {"(e)", "A_th x 0.5", {"contours.group_angle_deg=15"}},
      {"(e)", "A_th x 2", {"contours.group_angle_deg=60"}},
      {"(e)", "gain threshold x 0.5", {"gain.threshold=350"}},
      {"(e)", "gain threshold x 2", {"gain.threshold=1400"}}};
  return all;
}

std::vector<RunOf> plannedRuns(const ExperimentOptions& options) {
  std::vector<RunOf> runs;
  for (const Variant& variant : variants()) {
    if (options.quick && std::string(variant.part) != "-" && std::string(variant.part) != "(b)") continue;
    for (std::uint64_t seed = 1; seed <= options.seeds.value_or(options.quick ? 1 : 5); ++seed)
      runs.push_back(
          {.scene = "tabletop", .seed = seed, .variant = variant.name, .settings = variant.settings});
  }
  return runs;
}

std::vector<const ExplorationRun*> of(const Runs& runs, const std::string& variant) {
  std::vector<const ExplorationRun*> found;
  for (const ExplorationRun& run : runs)
    if (run.run.variant == variant) found.push_back(&run);
  return found;
}

/// At the first view.
SaliencyEnds saliencyEnds(const ExplorationRun& run) {
  return saliencyEnds(run.nbvs.front().segments);
}

Table resultTable(const Runs& runs) {
  Table table{"b2",
              "B2: one part changed at a time, scene S1 (tabletop), proposed",
              {"part", "variant", "ticks", "U_tau after 5", "U_box after 5", "AUC", "poses scored %", "rays",
               "most salient non-object", "least salient object", "NBV s"},
              {}};
  for (const Variant& variant : variants()) {
    const auto found = of(runs, variant.name);
    if (found.empty()) continue;
    const auto cell = [&](int decimals, const std::function<double(const ExplorationRun&)>& figure) {
      return spreadOver(found, figure).cell(decimals);
    };
    const auto sum = [](const ExplorationRun& run, std::uint64_t NbvResult::*count) {
      double total = 0.0;
      for (const NbvResult& nbv : run.nbvs) total += static_cast<double>(nbv.*count);
      return total;
    };
    table.rows.push_back({variant.part, variant.name,
                          cell(1, [](const ExplorationRun& r) { return double(r.ticks()); }),
                          cell(0, [](const ExplorationRun& r) { return r.unknown_near_objects.back(); }),
                          cell(0, [](const ExplorationRun& r) { return r.unknown_in_boxes.back(); }),
                          cell(0, [](const ExplorationRun& r) { return r.area(); }),
                          cell(1,
                               [&](const ExplorationRun& r) {
                                 const double generated = sum(r, &NbvResult::generated);
                                 return generated > 0 ? 100 * sum(r, &NbvResult::scored) / generated : 0.0;
                               }),
                          cell(0, [&](const ExplorationRun& r) { return sum(r, &NbvResult::rays); }),
                          cell(3, [](const ExplorationRun& r) { return saliencyEnds(r).other; }),
                          cell(3, [](const ExplorationRun& r) { return saliencyEnds(r).object; }),
                          cell(2, [](const ExplorationRun& r) { return r.seconds().nbv(); })});
  }
  return table;
}

/// Mean saliency of the most salient non-object under a variant; none if it was not run.
std::optional<double> noise(const Runs& runs, const char* variant) {
  const auto found = of(runs, variant);
  if (found.empty()) return std::nullopt;
  return spreadOver(found, [](const ExplorationRun& r) { return saliencyEnds(r).other; }).mean;
}
std::optional<double> least(const Runs& runs, const char* variant) {
  const auto found = of(runs, variant);
  if (found.empty()) return std::nullopt;
  return spreadOver(found, [](const ExplorationRun& r) { return saliencyEnds(r).object; }).mean;
}

/// (c): isolation cannot rise with B_th, so that noise could only stay as it is.
Claim judgeDistances(const Runs& runs) {
  Claim claim{"B2 (c)",
              "saliency of noise falls with B_th, and an object reaches 0 at 0.1 m",
              "Fig. 10",
              "not run",
              Verdict::NotRun,
              "most salient segment that is no object, at the first view; the paper's small objects are "
              "smaller than those of S1"};
  std::vector<double> noises;
  std::string text;
  for (const char* variant : {"B_th 0.005 m", "B_th 0.01 m", "as it is", "B_th 0.05 m", "B_th 0.1 m"}) {
    const auto value = noise(runs, variant);
    if (!value) return claim;
    noises.push_back(*value);
    text += fmt::format("{}{:.4f}", text.empty() ? "" : ", ", *value);
  }
  const double object = *least(runs, "B_th 0.1 m");
  claim.ours = fmt::format("{} at 5, 10, 20, 50, 100 mm; least object {:.4f} at 100 mm", text, object);
  const bool falls = std::ranges::is_sorted(noises, std::greater()) && noises.back() < noises.front();
  claim.verdict = passIf(falls && object == 0.0);
  return claim;
}

/// What the first view of S1 shows: (a), and the comparisons of saliency as pictures.
void addFirstView(const ExperimentOptions& options, Report& report) {
  const char* what = "B2 normals and pictures at the first view";
  if (!report.not_run.empty()) return report.not_run.push_back(what);
  try {
    options.say(what);
    const FirstStep first = firstStep(options);
    const std::vector<NormalsAtObject> objects = compareNormals(first);
    report.tables.push_back(normalsTable(objects));
    report.claims.push_back(judgeNormals(objects));
    report.claims.push_back(judgeNoise(rankNoise(firstStep(options, noisySettings()))));
    addSaliencyPictures(first, options.control, report);
  } catch (const Cancelled&) {
    report.not_run.push_back(what);
  }
}

}  // namespace

Report runB2(const ExperimentOptions& options) {
  Report report;
  const Runs runs = exploreAll("B2", plannedRuns(options), options, report);
  if (runs.empty()) return report;
  report.tables = {resultTable(runs)};
  report.defaults =
      contourDefaultsUsed(settingsOf(runs.front().run, sceneOf(runs.front().run), options.tune), "B2");
  addFirstView(options, report);
  report.claims.push_back(judgeDistances(runs));
  return report;
}

void checkB2(const ExperimentOptions& options) {
  for (const RunOf& run : plannedRuns(options)) settingsOf(run, sceneOf(run), options.tune);
}

}  // namespace vantage::experiments
