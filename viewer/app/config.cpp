#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "io/config_fields.h"
#include "viewer/app/command.h"
#include "viewer/app/inputs.h"
#include "viewer/app/json_output.h"

namespace vantage::app {

void addConfig(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto scene = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "config", "Print the effective configuration with each value's unit, range and origin");
  command->add_option("scene", *scene, "Embedded scene, scene TOML or data set whose settings apply")
      ->type_name("SCENE");
  command->footer("Example: vantage config tabletop --set saliency.isolation_distance_m=0.01");
  command->callback([&global, &action, scene] {
    action = [&global, scene] {
      const Settings settings = sceneSettings(global, *scene);
      if (global.json != "-") fmt::print("{}", effectiveToml(settings));
      nlohmann::ordered_json values;
      for (const config::Field& field : config::fields())
        values[field.key] = {{"value", config::toToml(field.get(settings), field.kind)},
                             {"origin", settings.origin(field.key)}};
      writeJson(global.json, values);
      return 0;
    };
  });
}

}  // namespace vantage::app
