#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "hardware/device_list.h"
#include "hardware/openni_camera.h"
#include "hardware/ros_bridge.h"
#include "viewer/app/command.h"
#include "viewer/app/json_output.h"

namespace vantage::app {
namespace {

using Json = nlohmann::ordered_json;

void printKind(const DeviceKind& kind) {
  fmt::print("{}: {}\n", kind.kind,
             kind.devices.empty() ? kind.note : fmt::format("{} found", kind.devices.size()));
  std::size_t name = 0, role = 0;
  for (const DeviceEntry& device : kind.devices) {
    name = std::max(name, device.name.size());
    role = std::max(role, device.role.size());
  }
  for (const DeviceEntry& device : kind.devices)
    fmt::print("  {:<{}}  {:<{}}  {}\n", device.name, name, device.role, role, device.description);
}

Json toJson(const DeviceKind& kind) {
  Json devices = Json::array();
  for (const DeviceEntry& device : kind.devices)
    devices.push_back({{"name", device.name}, {"role", device.role}, {"description", device.description}});
  return {{"kind", kind.kind}, {"built", kind.built}, {"note", kind.note}, {"devices", devices}};
}

int devices(const GlobalOptions& global) {
  Json all = Json::array();
  for (const DeviceKind& kind : {openNiDevices(), rosDevices()}) {
    if (global.json != "-") printKind(kind);
    all.push_back(toJson(kind));
  }
  writeJson(global.json, all);
  return 0;
}

}  // namespace

void addDevices(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand("devices", "List live cameras and arms that answer now");
  command->footer(
      "Example: vantage devices\n"
      "         vantage explore ros:/camera/depth/image_raw --robot ur5 --controller "
      "ros:/arm/follow_joint_trajectory");
  command->callback([&global, &action] { action = [&global] { return devices(global); }; });
}

}  // namespace vantage::app
