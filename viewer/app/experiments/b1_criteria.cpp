// Pass criteria of B1 (evaluation.md, section 4), on the core series.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>

#include "viewer/app/experiments/b1_report.h"

namespace vantage::experiments {
namespace {

/// The core series by method.
struct Core {
  std::vector<const ExplorationRun*> proposed, standard;
  std::vector<std::string> scenes;
  bool both() const { return !proposed.empty() && !standard.empty(); }
};

double share(double part, double all) {
  return all > 0 ? part / all : 0.0;
}

double sumOver(const std::vector<const ExplorationRun*>& runs, std::uint64_t NbvResult::*count) {
  double sum = 0.0;
  for (const ExplorationRun* run : runs)
    for (const NbvResult& nbv : run->nbvs) sum += static_cast<double>(nbv.*count);
  return sum;
}

/// Means of a scene's runs: proposed and standard.
std::pair<double, double> means(const Runs& runs, const std::string& scene,
                                const std::function<double(const ExplorationRun&)>& figure) {
  return {spreadOver(select(runs, Series::Core, true, scene), figure).mean,
          spreadOver(select(runs, Series::Core, false, scene), figure).mean};
}

Claim posesScored(const Core& core) {
  Claim claim{"B1 (1)",
              "poses scored by proposed, of all generated, over NBVs with a tick: at most 12 % on average",
              "about 9 % on average, 1.04 % in its example",
              "no NBV with a tick",
              Verdict::NotRun,
              ""};
  std::vector<double> shares, of_objects;
  for (const ExplorationRun* run : core.proposed)
    for (const NbvResult& nbv : run->nbvs)
      if (nbv.toward_object) {
        shares.push_back(share(static_cast<double>(nbv.scored), static_cast<double>(nbv.generated)));
        if (nbv.saliency_check) of_objects.push_back(nbv.saliency_check->object_pose_share);
      }
  if (shares.empty()) return claim;
  const double mean = spreadOf(shares).mean;
  claim.ours = fmt::format("{:.1f} %", 100 * mean);
  claim.verdict = passIf(mean <= 0.12);
  claim.remark =
      fmt::format("{} NBVs; least {:.2f} %; object segments hold {:.1f} % of the poses (paper: 11.4 %)",
                  shares.size(), 100 * std::ranges::min(shares), 100 * spreadOf(of_objects).mean);
  return claim;
}

Claim rayRatio(const Core& core) {
  const double proposed =
      sumOver(core.proposed, &NbvResult::rays) / static_cast<double>(core.proposed.size());
  const double standard =
      sumOver(core.standard, &NbvResult::rays) / static_cast<double>(core.standard.size());
  const double ratio = share(standard, proposed);
  return {"B1 (2a)",
          "rays cast, standard / proposed: at least 11",
          "11.1 by its times",
          fmt::format("{:.1f}", ratio),
          passIf(ratio >= 11.0),
          "an exact count, the same on every machine"};
}

Claim timeRatio(const Core& core) {
  const auto mean = [](const auto& runs, double (*figure)(const NbvSeconds&)) {
    return spreadOver(runs, [&](const ExplorationRun& r) { return figure(r.seconds()); }).mean;
  };
  const auto nbv = [](const NbvSeconds& s) { return s.nbv(); };
  const double proposed = mean(core.proposed, nbv), ratio = share(mean(core.standard, nbv), proposed);
  const double casting =
      share(mean(core.proposed, [](const NbvSeconds& s) { return s.evaluation; }), proposed);
  const double segments =
      share(mean(core.proposed, [](const NbvSeconds& s) { return s.segmentation; }), proposed);
  Claim claim{"B1 (2b)",
              "NBV computation, standard / proposed: at least 3.9",
              "3.92",
              fmt::format("{:.2f}", ratio),
              passIf(ratio >= 3.9),
              fmt::format("of proposed's time {:.0f} % is ray casting, {:.0f} % segmentation and saliency",
                          100 * casting, 100 * segments)};
  if (segments > casting && claim.verdict == Verdict::Missed) {
    claim.verdict = Verdict::NotComparable;
    claim.remark +=
        ": ray casting is so fast here that segmentation decides (graded while casting dominates)";
  }
  return claim;
}

Claim wholeRun(const Core& core) {
  const auto total = [](const ExplorationRun& r) { return r.seconds().total(); };
  const double ratio = share(spreadOver(core.standard, total).mean, spreadOver(core.proposed, total).mean);
  return {"B1 (2c)",
          "whole run, standard / proposed: above 1",
          "1.64",
          fmt::format("{:.2f}", ratio),
          passIf(ratio > 1.0),
          "motion is modelled, of the same speed for both"};
}

/// Ticks of all scenes, of five a scene, averaged over seeds.
double ticks(const std::vector<const ExplorationRun*>& runs, std::size_t scenes) {
  double sum = 0.0;
  for (const ExplorationRun* run : runs) sum += run->ticks();
  return sum / static_cast<double>(runs.size()) * static_cast<double>(scenes);
}

Claim tickCount(const Core& core) {
  const double proposed = ticks(core.proposed, core.scenes.size()),
               standard = ticks(core.standard, core.scenes.size());
  const double all = kNbvs * static_cast<double>(core.scenes.size());
  return {"B1 (3a)",
          "NBVs toward objects: at least 14 of 20 and more than standard",
          "15 against 7 of 20",
          fmt::format("{:.1f} against {:.1f} of {:.0f}", proposed, standard, all),
          passIf(proposed >= 0.7 * all && proposed > standard),
          "mean of the seeds"};
}

Claim tickOrder(const Runs& runs, const Core& core) {
  std::size_t ordered = 0;
  std::string text;
  for (const std::string& scene : core.scenes) {
    const auto found = select(runs, Series::Core, true, scene);
    const auto count = std::ranges::count_if(found, [](const ExplorationRun* r) { return r->ticksFirst(); });
    ordered += 2 * static_cast<std::size_t>(count) > found.size();
    text += fmt::format("{}{} {}/{}", text.empty() ? "" : ", ", scene, count, found.size());
  }
  return {"B1 (3b)",
          "no cross before a tick in at least 3 of 4 scenes",
          "4 of 4",
          fmt::format("{} of {}", ordered, core.scenes.size()),
          passIf(4 * ordered >= 3 * core.scenes.size()),
          "most of a scene's seeds: " + text};
}

Claim lower(const Runs& runs, const Core& core, const char* name, const char* words, std::size_t needed,
            const std::function<double(const ExplorationRun&)>& figure) {
  std::size_t lower = 0;
  std::string text;
  for (const std::string& scene : core.scenes) {
    const auto [proposed, standard] = means(runs, scene, figure);
    lower += proposed < standard;
    text += fmt::format("{}{} {:.0f} / {:.0f}", text.empty() ? "" : ", ", scene, proposed, standard);
  }
  return {name,
          words,
          "4 of 4 (Fig. 18)",
          fmt::format("{} of {}", lower, core.scenes.size()),
          passIf(4 * lower >= needed * core.scenes.size()),
          "proposed / standard, mean of the seeds: " + text};
}

Claim saliencyOrder(const Runs& runs) {
  Claim claim{"B1 (5)",
              "S1: all object segments with more than 5 contour points rank above table and panel; at least "
              "95 % of the "
              "object points lie in object segments",
              "Table 2: all nine",
              "not run",
              Verdict::NotRun,
              ""};
  std::size_t clouds = 0, ordered = 0;
  double least = 1.0;
  for (const ExplorationRun* run : select(runs, Series::Core, true, "tabletop"))
    for (const NbvResult& nbv : run->nbvs)
      if (nbv.saliency_check) {
        ++clouds;
        ordered += nbv.saliency_check->objects_first;
        least = std::min(least, nbv.saliency_check->object_share);
      }
  if (clouds == 0) return claim;
  claim.ours = fmt::format("{} of {} clouds, {:.1f} % at least", ordered, clouds, 100 * least);
  claim.verdict = passIf(ordered == clouds && least >= 0.95);
  claim.remark = "one cloud a planned view; against every group that is no object";
  return claim;
}

Claim largestPart(const Core& core) {
  const auto mean = [&](double NbvSeconds::*part) {
    return spreadOver(core.proposed, [&](const ExplorationRun& r) { return r.seconds().*part; }).mean;
  };
  const double segments = mean(&NbvSeconds::segmentation), generation = mean(&NbvSeconds::generation),
               evaluation = mean(&NbvSeconds::evaluation);
  const double all = segments + generation + evaluation;
  return {"B1 (6)",
          "segmentation and saliency are the largest part of proposed's NBV time",
          "62 %",
          fmt::format("{:.0f} %", 100 * share(segments, all)),
          passIf(segments > generation && segments > evaluation),
          fmt::format("evaluation {:.0f} %, generation {:.0f} %", 100 * share(evaluation, all),
                      100 * share(generation, all))};
}

/// On part of the protocol's runs a verdict means less.
void markReduced(const Core& core, std::vector<Claim>& claims) {
  constexpr std::size_t kScenes = 4, kSeeds = 5;
  const std::size_t seeds = core.proposed.size() / core.scenes.size();
  if (core.scenes.size() == kScenes && seeds >= kSeeds) return;
  const std::string part = fmt::format("on {} of {} scenes, {} of {} seeds", core.scenes.size(), kScenes,
                                       std::min(seeds, kSeeds), kSeeds);
  for (Claim& claim : claims) claim.remark = claim.remark.empty() ? part : part + "; " + claim.remark;
}

}  // namespace

void judgeB1(const Runs& runs, Report& report) {
  Core core{select(runs, Series::Core, true), select(runs, Series::Core, false), {}};
  for (const std::string& scene : scenesOf(runs))
    if (!select(runs, Series::Core, true, scene).empty() && !select(runs, Series::Core, false, scene).empty())
      core.scenes.push_back(scene);
  if (!core.both()) return;
  std::vector<Claim> claims;
  claims.push_back(posesScored(core));
  claims.push_back(rayRatio(core));
  claims.push_back(timeRatio(core));
  claims.push_back(wholeRun(core));
  claims.push_back(tickCount(core));
  claims.push_back(tickOrder(runs, core));
  claims.push_back(lower(runs, core, "B1 (4a)", "U_tau after five NBVs lower for proposed in all four scenes",
                         4, [](const ExplorationRun& r) { return r.unknown_near_objects.back(); }));
  claims.push_back(lower(runs, core, "B1 (4b)", "area under U_tau lower for proposed in at least 3 scenes", 3,
                         [](const ExplorationRun& r) { return r.area(); }));
  claims.push_back(saliencyOrder(runs));
  claims.push_back(largestPart(core));
  markReduced(core, claims);
  std::ranges::move(claims, std::back_inserter(report.claims));
}

}  // namespace vantage::experiments
