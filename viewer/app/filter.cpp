#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "core/perception/depth_filters.h"
#include "io/camera_file.h"
#include "io/depth_png.h"
#include "io/text_file.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/inputs.h"
#include "viewer/app/json_output.h"
#include "viewer/depth_picture.h"

namespace vantage::app {
namespace {

struct FilterOptions {
  std::string depth, camera, output, mask, picture, emitter_side;
  std::optional<double> emitter_offset_m;
  bool no_bilateral = false, no_shadow = false, no_veil = false, edge_aware = false;
};

/// The paper's three filters with the constants of the configuration; options switch them, whatever runs
/// are configured to do.
DepthFilterConfig configOf(const GlobalOptions& global, const FilterOptions& o) {
  for (const auto& [key, option] :
       {std::pair("filter.bilateral", "--no-bilateral"), std::pair("filter.shadow", "--no-shadow"),
        std::pair("filter.veil", "--no-veil"), std::pair("filter.edge_aware", "--edge-aware")})
    for (const std::string& assignment : global.assignments)
      if (assignment.starts_with(std::string(key) + "="))
        throw InputError("--set " + assignment,
                         std::string("switches a filter of a run; here ") + option + " does");
  DepthFilterConfig config = commandSettings(global).exploration.filter;
  config.bilateral = !o.no_bilateral;
  config.shadow = !o.no_shadow;
  config.veil = !o.no_veil;
  config.edge_aware = o.edge_aware;
  if (o.emitter_offset_m) {
    if (!(*o.emitter_offset_m >= 0.001 && *o.emitter_offset_m <= 1.0))
      throw InputError(
          fmt::format("--emitter-offset {:g}", *o.emitter_offset_m),
          "is the distance of camera and emitter, 0.001 .. 1 m; without an emitter beside the camera "
          "use --no-shadow");
    config.emitter_offset_m = *o.emitter_offset_m;
  }
  if (!o.emitter_side.empty())
    config.emitter_side = o.emitter_side == "left" ? EmitterSide::Left : EmitterSide::Right;
  return config;
}

/// The camera of an image. \throws InputError if it has another size
PinholeCamera cameraOf(const FilterOptions& o) {
  std::vector<std::string> warnings;
  const PinholeCamera camera = readCamera(o.camera, {}, &warnings);
  for (const std::string& warning : warnings) warn(warning);
  const ImageSize size = depthPngSize(o.depth);
  if (size != ImageSize{camera.width, camera.height})
    throw InputError(o.depth,
                     fmt::format("has {}x{} pixels, but {} is of a camera with {}x{}; give the image's own "
                                 "camera",
                                 size.width, size.height, o.camera, camera.width, camera.height));
  return camera;
}

void writePicture(const std::string& path, const DepthImage& measured, const FilteredDepth& filtered) {
  const auto [low, high] = depthRange(measured);
  writePng(filteredPicture(measured, filtered.mask, ColorMap::Cividis, low, high), path);
}

/// Mask values of the file: 0 kept, 1 shadow, 2 veil, 3 both, 4 was invalid, 8 edge-aware (added to 1..3).
int filter(const GlobalOptions& global, const FilterOptions& o) {
  requireDistinctFiles({{"DEPTH", o.depth},
                        {"--camera", o.camera},
                        {"-o", o.output},
                        {"--mask", o.mask},
                        {"--picture", o.picture},
                        {"--json", global.json}});
  for (const std::string& path : {o.output, o.mask, o.picture, global.json})
    if (!path.empty() && path != "-") requireCreatable(path);
  const DepthFilterConfig config = configOf(global, o);
  const PinholeCamera camera = cameraOf(o);
  const DepthImage measured = readDepthPng(o.depth);
  const FilteredDepth filtered = filterDepth(measured, camera, config);
  writeDepthPng(o.output, filtered.depth);
  if (!o.mask.empty()) writeBytePng(o.mask, measured.width, measured.height, filtered.mask);
  if (!o.picture.empty()) writePicture(o.picture, measured, filtered);

  const MaskCounts counts = countMask(filtered.mask);
  if (global.json != "-")
    say(global,
        fmt::format("{} of {} measured pixels kept; removed: shadow {}, veil {}, both {}, edge {}; {} were "
                    "invalid",
                    counts.kept, counts.kept + counts.removed(), counts.shadow, counts.veil, counts.both,
                    counts.edge, counts.invalid));
  writeJson(global.json, {{"kept", counts.kept},
                          {"shadow", counts.shadow},
                          {"veil", counts.veil},
                          {"both", counts.both},
                          {"edge", counts.edge},
                          {"invalid", counts.invalid}});
  return 0;
}

}  // namespace

void addFilter(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto o = std::make_shared<FilterOptions>();
  CLI::App* command = app.add_subcommand(
      "filter", "Remove shadow and veil pixels from a depth image (bilateral, Algorithm 2, eq. 19)");
  command->add_option("depth", o->depth, "16-bit grey, millimetres, 0 = invalid")
      ->required()
      ->type_name("DEPTH.png");
  command->add_option("--camera", o->camera, "Calibration as OpenCV or ROS writes it")
      ->required()
      ->type_name("CAM.yaml");
  command->add_option("-o,--output", o->output, "Filtered depth")->required()->type_name("OUT.png");
  command->add_flag("--no-bilateral", o->no_bilateral, "Do not smooth first");
  command->add_flag("--no-shadow", o->no_shadow, "Keep what the emitter may not light");
  command->add_flag("--no-veil", o->no_veil, "Keep what is seen at a grazing angle");
  command->add_flag("--edge-aware", o->edge_aware,
                    "Also remove what hangs between two sides of an edge (stand-in for the driver's filter)");
  command
      ->add_option("--emitter-offset", o->emitter_offset_m,
                   "Distance of camera and emitter, metres (default: 0.08)")
      ->type_name("M");
  command
      ->add_option("--emitter-side", o->emitter_side,
                   "Where the emitter stands, seen along the axis (default: left)")
      ->check(CLI::IsMember({"left", "right"}));
  command
      ->add_option(
          "--mask", o->mask,
          "Why pixels are gone: 0 kept, 1 shadow, 2 veil, 3 both, 4 was invalid, 8 edge-aware (is added)")
      ->type_name("FILE.png");
  command->add_option("--picture", o->picture, "The image with removed pixels coloured")
      ->type_name("FILE.png");
  command->footer(
      "In a picture: shadow red, veil pink, both purple, edge-aware green.\n"
      "Constants of the filters: --set filter.veil_angle_deg=10 and others, see 'vantage config'.\n"
      "Example: vantage filter depth.png --camera camera.yaml -o filtered.png --mask mask.png");
  command->callback([&global, &action, o] { action = [&global, o] { return filter(global, *o); }; });
}

}  // namespace vantage::app
