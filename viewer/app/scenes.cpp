#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/scene_file.h"
#include "viewer/app/command.h"
#include "viewer/app/json_output.h"

namespace vantage::app {
namespace {

int listScenes(const GlobalOptions& global) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::size_t width = 0;
  for (const EmbeddedScene& scene : embeddedScenes()) width = std::max(width, scene.name.size());
  for (const EmbeddedScene& scene : embeddedScenes()) {
    if (global.json != "-") fmt::print("{:<{}} {}\n", scene.name, width + 1, scene.description);
    list.push_back({{"name", scene.name}, {"description", scene.description}});
  }
  writeJson(global.json, list);
  return 0;
}

}  // namespace

void addScenes(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand("scenes", "List the embedded scenes");
  command->footer("Example: vantage scenes");
  command->callback([&global, &action] { action = [&global] { return listScenes(global); }; });
}

}  // namespace vantage::app
