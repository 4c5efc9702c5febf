#include "snapshots/snapshot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "io/error.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/inputs.h"
#include "viewer/app/json_output.h"
#include "viewer/app/picture_size.h"

namespace vantage::app {
namespace {

struct SnapshotOptions {
  std::string run, step = "all", size = "1280x800", output;
  std::vector<std::string> recipes, style;
};

/// Number of a step, SnapshotRequest::kEnd, or nothing for all.
std::optional<int> parseStep(const std::string& text) {
  if (text == "all") return std::nullopt;
  if (text == "end") return SnapshotRequest::kEnd;
  char* end = nullptr;
  const long step = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || step < 1 || step > 1'000'000)
    throw InputError("--step " + text, "not a step; give its number, 1 or more, 'end' or 'all'");
  return static_cast<int>(step);
}

std::string recipeHelp() {
  return fmt::format(
      "Which picture, repeatable: {}, or a TOML file of one's own; default: {} of steps planned on contours, "
      "{} of "
      "steps planned on the octree",
      fmt::join(recipeNames(), ", "), fmt::join(defaultRecipes(PlannerKind::Contour), ", "),
      fmt::join(defaultRecipes(PlannerKind::Hierarchical), ", "));
}

int snapshot(const GlobalOptions& global, const SnapshotOptions& options) {
  const std::string ending = std::filesystem::path(options.output).extension().string();
  if (options.output == "-" ||
      (!ending.empty() && ending != ".png" && !std::filesystem::is_directory(options.output)))
    throw InputError("-o " + options.output,
                     "pictures are PNG files; give a name ending in .png, or a folder");
  requireDistinctFiles({{"RUN", options.run}, {"-o", options.output}, {"--json", global.json}});
  SnapshotRequest request;
  if (const auto step = parseStep(options.step)) request.step = *step;
  request.recipes = options.recipes;
  request.style = options.style;
  std::tie(request.width, request.height) = parseSize("--size", options.size);
  request.output = options.output;
  Console console(global);
  const auto files = takeSnapshots(options.run, request, console.control());
  console.clear();
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& file : files) {
    say(global, file.string());
    list.push_back(file.string());
  }
  writeJson(global.json, {{"files", list}});
  return 0;
}

}  // namespace

void addSnapshot(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto options = std::make_shared<SnapshotOptions>();
  CLI::App* command = app.add_subcommand("snapshot", "Pictures of a recorded run as PNG, without a display");
  command->add_option("run", options->run, "Run file")->required()->type_name("RUN");
  command->add_option("--step", options->step, "Number of one step; end = the map after the last scan")
      ->type_name("N|end|all");
  command->add_option("--recipe", options->recipes, recipeHelp())
      ->type_name("NAME|FILE")
      ->allow_extra_args(false);
  command
      ->add_option("--style", options->style,
                   "How it is drawn, repeatable, keys as in a recipe file: octree_level=3, view_id=17, "
                   "coarse_rays=1000, utility_factor=distance, unknown_opacity=0.1, ...")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("--size", options->size, "Pixels; default: 1280x800")->type_name("WxH");
  command
      ->add_option("-o,--output", options->output,
                   "PNG file or folder; {run} {step} {view} in the name are filled in")
      ->required()
      ->type_name("FILE|DIR");
  command->footer("Example: vantage snapshot tabletop.vantage --step 2 --recipe segments -o segments.png");
  command->callback(
      [&global, &action, options] { action = [&global, options] { return snapshot(global, *options); }; });
}

}  // namespace vantage::app
