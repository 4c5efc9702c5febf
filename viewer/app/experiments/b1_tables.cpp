#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "viewer/app/experiments/b1_report.h"

namespace vantage::experiments {
namespace {

Cell count(std::uint64_t n) {
  return Cell::number(static_cast<double>(n));
}

struct Phase {
  const char* name;
  double (*seconds)(const NbvSeconds&);
  const char* paper_proposed;
  const char* paper_standard;
};
constexpr Phase kPhases[] = {
    {"segmentation + saliency", [](const NbvSeconds& s) { return s.segmentation; }, "46.1 +- 2.5", "-"},
    {"view generation", [](const NbvSeconds& s) { return s.generation; }, "2.1 +- 0.1", "2.1 +- 0.1"},
    {"view evaluation", [](const NbvSeconds& s) { return s.evaluation; }, "26.0 +- 4.1", "288.5 +- 39.0"},
    {"subtotal NBV", [](const NbvSeconds& s) { return s.nbv(); }, "74.2 +- 4.8", "290.6 +- 39.0"},
    {"planner map update", [](const NbvSeconds& s) { return s.map_update; }, "46.0 +- 1.6", "44.6 +- 0.4"},
    {"motion planning", [](const NbvSeconds& s) { return s.motion_planning; }, "88.1 +- 17.9",
     "78.3 +- 13.8"},
    {"robot motion (modelled)", [](const NbvSeconds& s) { return s.motion; }, "110.5 +- 3.9", "108.5 +- 7.7"},
    {"total", [](const NbvSeconds& s) { return s.total(); }, "318.7 +- 19.1", "522.0 +- 42.0"}};

std::string listed(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{:.0f}", text.empty() ? "" : " ", value);
  return text;
}

std::string ticksOf(const ExplorationRun& run) {
  std::string text;
  for (const NbvResult& nbv : run.nbvs)
    text += std::string(text.empty() ? "" : " ") + (!nbv.chosen ? "-" : nbv.toward_object ? "y" : "x");
  return text;
}

std::vector<Cell> runRow(const ExplorationRun& r) {
  return {r.run.scene,
          std::string(toString(r.run.series)),
          r.run.method(),
          count(r.run.seed),
          ticksOf(r),
          listed(r.unknown_near_objects),
          listed(r.unknown_in_boxes),
          Cell::number(r.area()),
          Cell::number(100 * r.coverage, 1),
          Cell::number(r.seconds().nbv(), 3),
          r.stop_reason};
}

}  // namespace

std::vector<const ExplorationRun*> select(const Runs& runs, Series series, bool proposed,
                                          const std::string& scene) {
  std::vector<const ExplorationRun*> found;
  for (const ExplorationRun& r : runs)
    if (r.run.series == series && r.run.proposed == proposed && (scene.empty() || r.run.scene == scene))
      found.push_back(&r);
  return found;
}

Spread spreadOver(const std::vector<const ExplorationRun*>& runs,
                  const std::function<double(const ExplorationRun&)>& figure) {
  std::vector<double> values;
  for (const ExplorationRun* run : runs) values.push_back(figure(*run));
  return spreadOf(values);
}

std::vector<std::string> scenesOf(const Runs& runs) {
  std::vector<std::string> scenes;
  for (const ExplorationRun& r : runs)
    if (std::ranges::find(scenes, r.run.scene) == scenes.end()) scenes.push_back(r.run.scene);
  return scenes;
}

Table nbvTable(const Runs& runs) {
  Table table{"b1",
              "B1: every next best view",
              {"scene", "series", "method", "seed", "NBV", "segment saliency", "poses scored", "generated",
               "rays", "gain px", "rank", "unreachable", "toward an object", "predicted voxels",
               "realised voxels", "U_tau after", "U_box after", "NBV s"},
              {}};
  for (const ExplorationRun& r : runs)
    for (std::size_t i = 0; i < r.nbvs.size(); ++i) {
      const NbvResult& nbv = r.nbvs[i];
      const auto ifChosen = [&](Cell cell) { return nbv.chosen ? std::move(cell) : Cell("-"); };
      table.rows.push_back(
          {r.run.scene, std::string(toString(r.run.series)), r.run.method(), count(r.run.seed), count(i + 1),
           ifChosen(r.run.proposed ? Cell::number(nbv.saliency, 3) : Cell("-")), count(nbv.scored),
           count(nbv.generated), count(nbv.rays), ifChosen(Cell::number(nbv.gain)), ifChosen(count(nbv.rank)),
           count(nbv.unreachable),
           !nbv.chosen         ? "none"
           : nbv.toward_object ? "yes"
                               : "no",
           ifChosen(count(nbv.gain_voxels)), ifChosen(count(nbv.realised_voxels)),
           Cell::number(r.unknown_near_objects[i + 1]), Cell::number(r.unknown_in_boxes[i + 1]),
           Cell::number(nbv.seconds.nbv(), 3)});
    }
  return table;
}

std::vector<Table> runTables(const Runs& runs) {
  const struct {
    const char *name, *title;
    std::vector<Series> series;
  } parts[] = {{"b1_runs", "B1: runs of the graded series", {Series::Core}},
               {"b1_series",
                "B1: runs of the other series: without the panel (open), a sensor with faults behind filters "
                "(filtered), "
                "no noise (exact)",
                {Series::Open, Series::Filtered, Series::Exact}},
               {"b1_arm", "B1: runs with a simulated Comau SMART SiX", {Series::Arm}},
               {"b1_unseen", "B1: scenes by somebody who had not seen the settings", {Series::Unseen}}};
  std::vector<Table> tables;
  for (const auto& part : parts) {
    Table table{
        part.name,
        std::string(part.title) +
            "; U_tau, U_box: unknown voxels near the objects and in their boxes after the initial scan "
            "and each NBV",
        {"scene", "series", "method", "seed", "ticks", "U_tau[0..5]", "U_box[0..5]", "AUC", "coverage %",
         "NBV s", "stop reason"},
        {}};
    for (const ExplorationRun& r : runs)
      if (std::ranges::find(part.series, r.run.series) != part.series.end()) table.rows.push_back(runRow(r));
    if (!table.rows.empty()) tables.push_back(std::move(table));
  }
  return tables;
}

Table phaseTable(const Runs& runs, Series series) {
  const auto proposed = select(runs, series, true), standard = select(runs, series, false);
  const bool arm = series == Series::Arm;
  Table table{arm ? "b1_table1_arm" : "b1_table1",
              std::string("B1, Table 1") + (arm ? " with the arm" : "") +
                  ": seconds of a run of five NBVs, mean +- standard deviation over all runs",
              {"phase", "paper proposed", "paper standard", "proposed", "standard", "standard / proposed"},
              {}};
  if (arm && proposed.empty() && standard.empty()) return table;
  for (const Phase& phase : kPhases) {
    const auto seconds = [&](const ExplorationRun& run) { return phase.seconds(run.seconds()); };
    const Spread p = spreadOver(proposed, seconds), s = spreadOver(standard, seconds);
    table.rows.push_back({phase.name, phase.paper_proposed, phase.paper_standard,
                          proposed.empty() ? Cell("-") : p.cell(3), standard.empty() ? Cell("-") : s.cell(3),
                          p.mean > 0 && s.mean > 0 ? Cell::number(s.mean / p.mean, 2) : Cell("-")});
  }
  return table;
}

Table tickTable(const Runs& runs) {
  Table table{"b1_table3",
              "B1, Table 3: NBVs toward objects (y), elsewhere (x), none (-), by scene and seed",
              {"method", "scene", "seed", "NBV 1 to 5", "ticks"},
              {}};
  const struct {
    const char *method, *scene, *ticks;
    int count;
  } paper[] = {{"paper: proposed", "1", "y y y y x", 4}, {"paper: proposed", "2", "y y y x x", 3},
               {"paper: proposed", "3", "y y y x x", 3}, {"paper: proposed", "4", "y y y y y", 5},
               {"paper: standard", "1", "x y x y x", 2}, {"paper: standard", "2", "y x x x y", 2},
               {"paper: standard", "3", "x x y x y", 2}, {"paper: standard", "4", "x x y x x", 1}};
  for (const auto& p : paper) table.rows.push_back({p.method, p.scene, "-", p.ticks, Cell::number(p.count)});
  for (const bool proposed : {true, false})
    for (const std::string& scene : scenesOf(runs))
      for (const ExplorationRun* r : select(runs, Series::Core, proposed, scene))
        table.rows.push_back(
            {r->run.method(), scene, count(r->run.seed), ticksOf(*r), Cell::number(r->ticks())});
  return table;
}

Table segmentTable(const Runs& runs) {
  Table table{
      "b1_table2",
      "B1, Table 2: segments of the third NBV on S1 (tabletop), first seed; the paper's example has 91 960 "
      "poses, of which 960 were scored",
      {"order", "saliency", "poses", "contour points", "true object"},
      {}};
  const auto found = select(runs, Series::Core, true, "tabletop");
  if (found.empty()) return table;
  bool other_seen = false;
  const std::vector<SegmentRow>& segments = found.front()->nbvs[2].segments;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const SegmentRow& s = segments[i];
    const bool first_other = s.object.empty() && !std::exchange(other_seen, other_seen || s.object.empty());
    table.rows.push_back({count(i + 1), Cell::number(s.saliency, 3), count(s.poses), count(s.contour_points),
                          !s.object.empty() ? s.object
                          : first_other     ? "none (first non-object)"
                                            : "none"});
  }
  return table;
}

std::vector<LinePlot> unknownPlots(const Runs& runs) {
  std::vector<LinePlot> plots;
  for (const std::string& scene : scenesOf(runs)) {
    LinePlot plot{"B1, Fig. 18: unknown voxels within 5 cm of the objects, " + scene,
                  "scan",
                  "U_tau, mean of seeds",
                  {}};
    for (const bool proposed : {true, false}) {
      const auto found = select(runs, Series::Core, proposed, scene);
      if (found.empty()) continue;
      std::vector<double> mean;
      for (std::size_t i = 0; i <= kNbvs; ++i)
        mean.push_back(
            spreadOver(found, [i](const ExplorationRun& r) { return r.unknown_near_objects[i]; }).mean);
      plot.series.push_back({proposed ? "proposed" : "standard", std::move(mean)});
    }
    if (!plot.series.empty()) plots.push_back(std::move(plot));
  }
  return plots;
}

}  // namespace vantage::experiments
