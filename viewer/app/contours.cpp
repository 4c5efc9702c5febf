#include "core/perception/contours.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "io/table_file.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/inputs.h"
#include "viewer/app/json_output.h"

namespace vantage::app {
namespace {

struct ContourOptions {
  std::string map, voxels, points;
};

int contours(const GlobalOptions& global, const ContourOptions& options) {
  requireDistinctFiles(
      {{"MAP", options.map}, {"-o", options.voxels}, {"--points", options.points}, {"--json", global.json}});
  const LoadedMap map = loadMap(global, options.map);
  const Contours found = extractContours(map.volume, map.settings.exploration.contour.contours);
  writeContourVoxels(options.voxels, map.volume.geometry(), found.voxels);
  if (!options.points.empty()) writeContourPoints(options.points, found.points);
  if (options.voxels != "-" && options.points != "-" && global.json != "-")
    say(global,
        fmt::format("{} contour voxels, {} contour points", found.voxels.size(), found.points.size()));
  writeJson(global.json, {{"contour_voxels", found.voxels.size()}, {"contour_points", found.points.size()}});
  return 0;
}

}  // namespace

void addContours(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto options = std::make_shared<ContourOptions>();
  CLI::App* command = app.add_subcommand("contours", "Contour voxels and contour points of a map");
  command->add_option("map", options->map, "TSDF (.vti) or RUN#STEP")->required()->type_name("MAP");
  command->add_option("-o,--output", options->voxels, "Contour voxels, CSV")
      ->required()
      ->type_name("VOXELS.csv");
  command->add_option("--points", options->points, "Contour points, CSV")->type_name("POINTS.csv");
  command->footer("Example: vantage contours map.vti -o voxels.csv --points points.csv");
  command->callback(
      [&global, &action, options] { action = [&global, options] { return contours(global, *options); }; });
}

}  // namespace vantage::app
