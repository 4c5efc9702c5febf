#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/perception/saliency.h"
#include "io/cloud_file.h"
#include "io/table_file.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/inputs.h"
#include "viewer/app/json_output.h"

namespace vantage::app {
namespace {

struct SegmentOptions {
  std::string input, output, cloud;
};

bool isCloudFile(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".pcd" || extension == ".ply";
}

int segment(const GlobalOptions& global, const SegmentOptions& options) {
  requireDistinctFiles({{"input", options.input},
                        {"-o", options.output},
                        {"--cloud", options.cloud},
                        {"--json", global.json}});
  if (!options.cloud.empty()) requireEnding("--cloud", options.cloud, {".pcd"});
  SurfaceCloud cloud;
  Settings settings;
  if (isCloudFile(options.input)) {
    cloud = readCloud(options.input);
    settings = commandSettings(global);
  } else {
    const LoadedMap map = loadMap(global, options.input);
    settings = map.settings;
    cloud = extractSurface(map.volume, settings.exploration.contour.contours.weight_threshold);
  }
  const ContourPlannerConfig& planner = settings.exploration.contour;
  const Labels labels = segmentSurface(cloud, planner.segmentation);
  const Saliency saliency = computeSaliency(cloud, labels, planner.saliency);
  std::vector<Segment> ranked;
  for (const std::uint32_t index : bySaliency(saliency.segments)) ranked.push_back(saliency.segments[index]);
  writeSegments(options.output, ranked);
  if (!options.cloud.empty()) writeLabelledCloud(options.cloud, cloud, labels.of_point);
  writeJson(
      global.json,
      {{"points", cloud.points.size()}, {"supervoxels", labels.supervoxels}, {"segments", labels.count}});
  if (options.output != "-")
    say(global, fmt::format("{} points, {} supervoxels, {} segments", cloud.points.size(), labels.supervoxels,
                            labels.count));
  return 0;
}

}  // namespace

void addSegment(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto options = std::make_shared<SegmentOptions>();
  CLI::App* command = app.add_subcommand("segment", "LCCP segments of a cloud or map, with their saliency");
  command->add_option("input", options->input, "Cloud (.pcd, .ply), TSDF (.vti) or RUN#STEP")
      ->required()
      ->type_name("CLOUD|MAP");
  command->add_option("-o,--output", options->output, "Segments by decreasing saliency, CSV")
      ->required()
      ->type_name("SEGMENTS.csv");
  command->add_option("--cloud", options->cloud, "The points with their labels")->type_name("LABELLED.pcd");
  command->footer("Example: vantage segment map.vti -o segments.csv --cloud labelled.pcd");
  command->callback(
      [&global, &action, options] { action = [&global, options] { return segment(global, *options); }; });
}

}  // namespace vantage::app
