#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "core/planners/hierarchical_planner.h"
#include "core/views/contour_views.h"
#include "io/table_file.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/inputs.h"
#include "viewer/app/json_output.h"

namespace vantage::app {
namespace {

struct ViewOptions {
  std::string map, output, generator = "contour";
  std::optional<int> count;
};

/// Views and what is to be said about them.
struct MadeViews {
  std::vector<ViewRow> rows;
  std::string origin;           ///< "of 12 contour points"
  nlohmann::ordered_json json;  ///< beside the number of views
};

MadeViews contourCandidates(const GlobalOptions& global, const ViewOptions& options) {
  if (options.count)
    throw InputError("--count",
                     "does not go with the contour generator, which makes its views from what it "
                     "finds; leave it out or use --generator icosphere or workspace");
  const LoadedMap map = loadMap(global, options.map, MapNeed::Tsdf);
  const ContourPlannerConfig& planner = map.settings.exploration.contour;
  const Contours found = extractContours(map.volume, planner.contours);
  MadeViews made;
  for (const CandidateView& view : contourViews(found.points, planner.views))
    made.rows.push_back({view.id, view.T_world_camera, view.group});
  made.origin = fmt::format("of {} contour points", found.points.size());
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

/// The object's box: as configured, else that of the map.
Box objectBoxOf(const LoadedMap& map) {
  const ExplorationConfig& exploration = map.settings.exploration;
  const bool configured = exploration.octree.object_box.volume() > 0.0;
  return map.octree && !configured ? map.octree->objectBox() : exploration.objectBox();
}

/// Candidates of the hierarchical planner.
MadeViews planningCandidates(const GlobalOptions& global, const ViewOptions& options) {
  const LoadedMap map = loadMap(global, options.map, MapNeed::Either);
  HierarchicalPlannerConfig config = map.settings.exploration.hierarchical;
  MadeViews made;
  const Box mapped = map.octree ? map.octree->geometry().bounds() : map.volume.geometry().bounds();
  if (options.generator == "icosphere") {
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
       makeCandidates(config, objectBoxOf(map), mapped, map.settings.exploration.seed))
    made.rows.push_back({view.id, view.T_world_camera, std::nullopt});
  return made;
}

int views(const GlobalOptions& global, const ViewOptions& options) {
  requireDistinctFiles({{"MAP", options.map}, {"-o", options.output}, {"--json", global.json}});
  const MadeViews made = options.generator == "contour" ? contourCandidates(global, options)
                                                        : planningCandidates(global, options);
  writeViews(options.output, made.rows);
  nlohmann::ordered_json json = {{"views", made.rows.size()}, {"generator", options.generator}};
  json.update(made.json);
  writeJson(global.json, json);
  if (options.output != "-") say(global, fmt::format("{} views {}", made.rows.size(), made.origin));
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
  command->add_option("--generator", options->generator, "How candidates are made")
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
