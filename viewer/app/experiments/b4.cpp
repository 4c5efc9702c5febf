// B4: share of lit pixels among those that the shadow filter removes (Table 5 of Monica & Aleotti 2017).
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "viewer/app/experiments/b4_bar.h"
#include "viewer/app/experiments/experiments.h"

namespace vantage::experiments {
namespace {

constexpr std::array<double, 5> kAngles_deg = {-60, -30, 0, 30, 60};
constexpr std::array<double, 3> kWidths_m = {0.04, 0.08, 0.16};

/// Rows by width, a value for each angle, per cent: what the paper prints, and what evaluation.md computed
/// for the scene as described, which the runs are compared with.
struct Reference {
  const char* source;
  std::array<std::array<double, 5>, 3> fdr_percent;
};
constexpr Reference kPaper = {"paper", {{{41, 50, 50, 47, 42}, {0, 1, 4, 5, 7}, {1, 0, 0, 14, 5}}}};
constexpr Reference kComputed = {
    "computed from the description",
    {{{4.7, 0.9, 14.2, 0.8, 11.7}, {0.9, 0.8, 0.0, 0.7, 1.0}, {1.2, 1.1, 0.0, 0.9, 1.2}}}};

struct Variant {
  const char* name;
  BarScene scene;  ///< without width and angle
};

std::vector<Variant> variants() {
  BarScene thin, far, wide;
  thin.depth_m = 0.01;
  far.wall_m = 15.0;
  far.range_limit = false;
  wide.emitter_offset_m = 0.133;
  return {{"as described", {}},
          {"bar 1 cm thick", thin},
          {"wall at 15 m, no range limit", far},
          {"emitter offset 13.3 cm", wide}};
}

using Results = std::array<std::array<BarResult, 5>, 3>;

Results measure(const BarScene& scene, const RunControl& control) {
  Results results;
  for (std::size_t w = 0; w < kWidths_m.size(); ++w)
    for (std::size_t a = 0; a < kAngles_deg.size(); ++a) {
      control.check();
      BarScene one = scene;
      one.width_m = kWidths_m[w];
      one.angle_rad = kAngles_deg[a] * std::numbers::pi / 180.0;
      results[w][a] = measureBar(one);
    }
  return results;
}

void addReference(Table& table, const Reference& reference) {
  for (std::size_t w = 0; w < kWidths_m.size(); ++w)
    for (std::size_t a = 0; a < kAngles_deg.size(); ++a)
      table.rows.push_back({reference.source, Cell::number(100 * kWidths_m[w], 0, " cm"),
                            Cell::number(kAngles_deg[a], 0, " deg"), "-", "-",
                            Cell::number(reference.fdr_percent[w][a], 1, " %"), "-", "-"});
}

void addResults(Table& table, const char* name, const Results& results) {
  for (std::size_t w = 0; w < kWidths_m.size(); ++w)
    for (std::size_t a = 0; a < kAngles_deg.size(); ++a) {
      const BarResult& r = results[w][a];
      const auto pixels = [](std::uint64_t n) { return Cell::number(static_cast<double>(n)); };
      table.rows.push_back({name, Cell::number(100 * kWidths_m[w], 0, " cm"),
                            Cell::number(kAngles_deg[a], 0, " deg"), pixels(r.removed), pixels(r.removed_lit),
                            Cell::number(r.fdr_percent(), 1, " %"), pixels(r.shadowed), pixels(r.missed())});
    }
}

/// Largest difference from the values of the specification, points.
double farthest(const Results& results) {
  double most = 0.0;
  for (std::size_t w = 0; w < kWidths_m.size(); ++w)
    for (std::size_t a = 0; a < kAngles_deg.size(); ++a)
      most = std::max(most, std::abs(results[w][a].fdr_percent() - kComputed.fdr_percent[w][a]));
  return most;
}

/// Of the bars that are wider than the break-even width.
double highestOfWide(const Results& results) {
  double most = 0.0;
  for (std::size_t w = 1; w < kWidths_m.size(); ++w)
    for (const BarResult& r : results[w]) most = std::max(most, r.fdr_percent());
  return most;
}

void judge(const Results& described, Report& report) {
  const double off = farthest(described), wide = highestOfWide(described);
  const double narrow = described[0][2].fdr_percent(), middle = described[1][2].fdr_percent();
  report.claims.push_back(
      {"B4 (1)", "within 2 points of what the described geometry gives", "41 to 50 % at 4 cm",
       fmt::format("{:.1f} points off at most", off), passIf(off <= 2.0),
       "the paper's level does not follow from its geometry: 50 % at 0 deg needs a background at "
       "infinity or an offset of 13.3 cm"});
  report.claims.push_back({"B4 (2)", "FDR of 4 cm above that of 8 cm at 0 deg", "50 against 4 %",
                           fmt::format("{:.1f} against {:.1f} %", narrow, middle), passIf(narrow > middle),
                           ""});
  report.claims.push_back({"B4 (3)", "8 and 16 cm at most 3 % everywhere", "14 % at most",
                           fmt::format("{:.1f} % at most", wide), passIf(wide <= 3.0),
                           "the paper's 14 % at 16 cm and 30 deg is unexplained"});
}

/// A plate of 1 mm before a wall alone: FDR = max(0, 1 - w z2 / (Delta (z2 - z1))).
void addClosedForm(Report& report, const RunControl& control) {
  constexpr std::array<double, 5> kPlates_m = {0.02, 0.03, 0.04, 0.045, 0.05};
  Table table{"b4_closed_form",
              "B4: plate of 1 mm, no ground, 0 deg: FDR against the closed form",
              {"width", "FDR", "closed form"},
              {}};
  double most = 0.0;
  for (const double width_m : kPlates_m) {
    control.check();
    BarScene plate;
    plate.width_m = width_m;
    plate.depth_m = 0.001;
    plate.ground = false;
    const double fdr = measureBar(plate).fdr_percent();
    const double expected = 100.0 * plateFdr(width_m, 1.0, 2.5, plate.emitter_offset_m);
    most = std::max(most, std::abs(fdr - expected));
    table.rows.push_back(
        {Cell::number(100 * width_m, 1, " cm"), Cell::number(fdr, 1, " %"), Cell::number(expected, 1, " %")});
  }
  report.tables.push_back(std::move(table));
  report.claims.push_back({"B4 (4)", "closed form of a thin plate met within 6 points", "-",
                           fmt::format("{:.1f} points off at most", most), passIf(most <= 6.0),
                           "6 points are one of 17 pixel columns"});
}

}  // namespace

Report runB4(const ExperimentOptions& options) {
  Report report;
  Table table{"b4",
              "B4: shadow filter on a bar before a wall; FDR = lit pixels among the removed",
              {"variant", "width", "angle", "removed", "lit among removed", "FDR", "shadowed",
               "shadowed not removed"},
              {}};
  try {
    const std::vector<Variant> all = options.quick ? std::vector{variants().front()} : variants();
    Results described;
    std::vector<Results> results;
    for (const Variant& variant : all) results.push_back(measure(variant.scene, options.control));
    addReference(table, kPaper);
    addReference(table, kComputed);
    for (std::size_t i = 0; i < all.size(); ++i) addResults(table, all[i].name, results[i]);
    report.tables.push_back(std::move(table));
    judge(results.front(), report);
    addClosedForm(report, options.control);
    options.say(fmt::format("B4: {} variants of 15 views each", all.size()));
  } catch (const Cancelled&) {
    report.not_run.push_back("B4");
    return report;
  }
  report.notes.push_back(
      "B4: the paper's rows stand beside ours. For a plate and a wall the filter removes a strip of Delta "
      "(z2/z1 - 1), "
      "of which w z2/z1 is dark: 16.7 % at 4 cm, none from 4.8 cm on. The trend is confirmed, the level "
      "cannot be.");
  return report;
}

}  // namespace vantage::experiments
