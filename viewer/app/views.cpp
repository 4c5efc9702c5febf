#include <fmt/format.h>

#include <nlohmann/json.hpp>

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
};

int views(const GlobalOptions& global, const ViewOptions& options) {
  requireDistinctFiles({{"MAP", options.map}, {"-o", options.output}, {"--json", global.json}});
  const LoadedMap map = loadMap(global, options.map);
  const ContourPlannerConfig& planner = map.settings.exploration.planner;
  const Contours found = extractContours(map.volume, planner.contours);
  std::vector<ViewRow> rows;
  for (const CandidateView& view : contourViews(found.points, planner.views))
    rows.push_back({view.id, view.T_world_camera, view.group});
  writeViews(options.output, rows);
  writeJson(global.json, {{"views", rows.size()}, {"contour_points", found.points.size()}});
  if (options.output != "-")
    say(global, fmt::format("{} views of {} contour points", rows.size(), found.points.size()));
  return 0;
}

}  // namespace

void addViews(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* command = app.add_subcommand("views", "Candidate view poses of a map");
  command->add_option("map", options->map, "TSDF (.vti) or RUN#STEP")->required()->type_name("MAP");
  command->add_option("-o,--output", options->output, "View poses, CSV")->required()->type_name("VIEWS.csv");
  command->add_option("--generator", options->generator, "How candidates are made")
      ->check(CLI::IsMember({"contour"}));
  command->footer("Example: vantage views map.vti -o views.csv");
  command->callback(
      [&global, &action, options] { action = [&global, options] { return views(global, *options); }; });
}

}  // namespace vantage::app
