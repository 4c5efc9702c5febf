#include <fmt/format.h>
#include <tbb/global_control.h>

#include <fstream>
#include <numbers>
#include <string>
#include <thread>

#include "io/config_file.h"
#include "viewer/app/experiments/experiments.h"

namespace vantage::experiments {
namespace {

/// Value of the first line `KEY : VALUE` of a file in /proc.
std::string procValue(const char* file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(key)) {
      const std::size_t value = line.find_first_not_of(" \t", line.find(':') + 1);
      return value == std::string::npos ? "" : line.substr(value);
    }
  return "unknown";
}

}  // namespace

std::vector<std::string> machineText() {
  const auto threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return {fmt::format("processor: {}, {} hardware threads", procValue("/proc/cpuinfo", "model name"),
                      std::thread::hardware_concurrency()),
          fmt::format("threads used: {}", threads),
          fmt::format("memory: {}", procValue("/proc/meminfo", "MemTotal"))};
}

std::vector<DefaultUsed> defaultsUsed(const Settings& settings) {
  constexpr double kDegree = std::numbers::pi / 180;
  const HierarchicalPlannerConfig& h = settings.exploration.hierarchical;
  const OccupancyConfig& o = settings.exploration.octree.occupancy;
  const auto text = [](auto value) { return fmt::format("{:g}", static_cast<double>(value)); };
  return {
      {"radius of the view sphere", text(h.sphere_radius_m) + " m", "released example configuration"},
      {"aperture a_h x a_v",
       fmt::format("{:.3g} x {:.3g} deg", h.sensor.horizontal_fov_rad / kDegree,
                   h.sensor.vertical_fov_rad / kDegree),
       "Kinect"},
      {"range d_min, d", fmt::format("{:g}, {:g} m", h.sensor.min_range_m, h.sensor.max_range_m),
       "released example"},
      {"coarse levels m", text(h.coarse_levels), "gains degrade for m >= 3 (section 10.4)"},
      {"least known surface h_oc", text(h.min_occupied) + " rays", "50 cm2 face-on at 1 m"},
      {"stop threshold h_stop", text(h.stop_gain) + " rays", "library default of the released code"},
      {"robot box RBB", text(h.body_m) + " m", "released example"},
      {"hit / miss probability", fmt::format("{:g} / {:g}", o.hit_probability, o.miss_probability),
       "OctoMap's defaults"},
      {"clamping", fmt::format("{:g} .. {:g}", o.clamp_min, o.clamp_max), "OctoMap's defaults"},
      {"unknown band", fmt::format("[{:g}, {:g})", o.unknown_low, o.unknown_high), "released code (D-A7)"},
      {"inner nodes", o.inner == InnerRule::Max ? "max" : "mean", "D-A5"},
      {"around the object's box", "free; boxes of the scene (table, walls, furniture) known", "D-A10"},
      {"children of rays", h.child_start == ChildStart::Resume ? "resume" : "restart", "D-A11"},
      {"rotation weight w", text(h.rotation_weight_m_per_rad) + " m/rad", "D-A17"},
      {"range of insertion", text(o.insert_range_m) + " m", "released example"},
      {"object sizes", "0.20 m and 0.35 m", "the paper gives none; both are shown"},
      {"most planning steps", text(settings.exploration.steps), "the paper needed 10 to 15"},
  };
}

}  // namespace vantage::experiments
