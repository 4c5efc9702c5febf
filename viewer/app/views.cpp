#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "core/planners/hierarchical_planner.h"
#include "core/views/contour_views.h"
#include "io/table_file.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/counted.h"
#include "viewer/app/inputs.h"
#include "viewer/app/json_output.h"

namespace vantage::app {
namespace {

struct ViewOptions {
  std::string map, output;
  std::string generator;  ///< empty: what the settings or the map suggest
  std::optional<int> count;
};

/// Views and what is to be said about them.
struct MadeViews {
  std::vector<ViewRow> rows;
  std::string origin;           ///< "of 12 contour points"
  nlohmann::ordered_json json;  ///< beside the number of views
};

MadeViews contourCandidates(const LoadedMap& map, const ViewOptions& options) {
  if (options.count)
    throw InputError("--count",
                     "does not go with the contour generator, which makes its views from what it "
                     "finds; leave it out or use --generator icosphere or workspace");
  if (!map.hasVolume())
    throw InputError(
        options.map,
        "is an octree, and contours are found in a TSDF; add --generator icosphere or --generator "
        "workspace, or give a .vti file");
  const ContourPlannerConfig& planner = map.settings.exploration.contour;
  const Contours found = extractContours(map.volume, planner.contours);
  MadeViews made;
  for (const CandidateView& view : contourViews(found.points, planner.views))
    made.rows.push_back({view.id, view.T_world_camera, view.group});
  made.origin = "of " + counted(found.points.size(), "contour point");
  made.json = {{"contour_points", found.points.size()}};
  return made;
}

/// \throws InputError naming the nearest numbers of faces
int subdivisionsFor(int count) {
  constexpr int kMost = 6;
  int faces = 20, n = 0;
  for (; faces < count && n < kMost; faces *= 4) ++n;
  if (faces == count) return n;
  const int lower = n == 0 || count > faces ? faces : faces / 4;
  const int upper = n == 0 ? 4 * faces : faces;
  throw InputError(
      fmt::format("--count {}", count),
      lower == upper
          ? fmt::format("an icosphere has 20 * 4^n faces, here at most {}", faces)
          : fmt::format("an icosphere has 20 * 4^n faces; the nearest numbers are {} and {}", lower, upper));
}

/// Candidates of the hierarchical planner.
MadeViews planningCandidates(const LoadedMap& map, const ViewOptions& options, const std::string& generator) {
  HierarchicalPlannerConfig config = map.settings.exploration.hierarchical;
  MadeViews made;
  if (generator == "icosphere") {
    config.generator = CandidateGenerator::Icosphere;
    if (options.count) config.icosphere_subdivisions = subdivisionsFor(*options.count);
    made.origin = fmt::format("on a sphere of {:g} m around the object's box", config.sphere_radius_m);
    made.json = {{"radius_m", config.sphere_radius_m}};
  } else {
    config.generator = CandidateGenerator::Workspace;
    if (options.count) config.workspace_views = *options.count;
    made.origin = fmt::format("drawn in the mapped volume, seed {}", map.settings.exploration.seed);
    made.json = {{"seed", map.settings.exploration.seed}};
  }
  for (const ViewCandidate& view :
       makeCandidates(config, objectBoxOf(map), mappedBox(map), map.settings.exploration.seed))
    made.rows.push_back({view.id, view.T_world_camera, std::nullopt});
  return made;
}

/// As asked for, else as set for this command, else by the planner of a recorded step.
std::string generatorFor(const LoadedMap& map, const ViewOptions& options) {
  if (!options.generator.empty()) return options.generator;
  const std::string origin = map.settings.origin("candidates.generator");
  const std::string run = options.map.substr(0, options.map.rfind('#'));
  const bool by_octree = map.record && map.record->utilities;
  if (!by_octree && (origin == "default" || origin == run)) return "contour";
  const bool icosphere = map.settings.exploration.hierarchical.generator == CandidateGenerator::Icosphere;
  return icosphere ? "icosphere" : "workspace";
}

int views(const GlobalOptions& global, const ViewOptions& options) {
  requireDistinctFiles({{"MAP", options.map}, {"-o", options.output}, {"--json", global.json}});
  const LoadedMap map = loadMap(global, options.map, MapNeed::Either);
  const std::string generator = generatorFor(map, options);
  const MadeViews made =
      generator == "contour" ? contourCandidates(map, options) : planningCandidates(map, options, generator);
  writeViews(options.output, made.rows);
  nlohmann::ordered_json json = {{"views", made.rows.size()}, {"generator", generator}};
  json.update(made.json);
  writeJson(global.json, json);
  if (options.output != "-") say(global, counted(made.rows.size(), "view") + ' ' + made.origin);
  return 0;
}

}  // namespace

void addViews(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* command = app.add_subcommand("views", "Candidate view poses of a map");
  command->add_option("map", options->map, "TSDF (.vti), octree (.bt, .ot) or RUN#STEP")
      ->required()
      ->type_name("MAP");
  command->add_option("-o,--output", options->output, "View poses, CSV")->required()->type_name("VIEWS.csv");
  command
      ->add_option("--generator", options->generator,
                   "How candidates are made (default: contour; of a step planned on the octree its own)")
      ->check(CLI::IsMember({"contour", "icosphere", "workspace"}));
  command
      ->add_option("--count", options->count,
                   "Number of views: icosphere: 20, 80, 320, 1280, ...; workspace: any")
      ->check(CLI::Range(0, 1000000))
      ->type_name("N");
  command->footer("Example: vantage views map.bt -o views.csv --generator icosphere --count 320");
  command->callback(
      [&global, &action, options] { action = [&global, options] { return views(global, *options); }; });
}

}  // namespace vantage::app
