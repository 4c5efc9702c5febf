#include <fmt/format.h>

#include "viewer/app/command.h"
#include "viewer/app/inputs.h"

namespace vantage::app {

void addConfig(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto scene = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "config", "Print the effective configuration with each value's unit, range and origin");
  command->add_option("scene", *scene, "Embedded scene or scene TOML whose settings apply")
      ->type_name("SCENE");
  command->footer("Example: vantage config tabletop --set saliency.isolation_distance_m=0.01");
  command->callback([&global, &action, scene] {
    action = [&global, scene] {
      fmt::print("{}", effectiveToml(sceneSettings(global, *scene)));
      return 0;
    };
  });
}

}  // namespace vantage::app
