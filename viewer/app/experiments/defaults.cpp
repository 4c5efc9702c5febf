#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <string>

#include "io/config_file.h"
#include "viewer/app/experiments/experiments.h"

namespace vantage::experiments {
namespace {

std::string number(double value) {
  return fmt::format("{:g}", value);
}

std::string candidatesText(const ExplorationConfig& exploration) {
  const HierarchicalPlannerConfig& h = exploration.hierarchical;
  const std::string made = h.generator == CandidateGenerator::Workspace
                               ? fmt::format("{} drawn in the workspace", h.workspace_views)
                               : fmt::format("{} faces of an icosphere, radius {:g} m",
                                             20 << (2 * h.icosphere_subdivisions), h.sphere_radius_m);
  return made + (exploration.recorded_candidates ? ", and the recorded poses that are left" : "");
}

std::string surfaceText(const HierarchicalPlannerConfig& h, const char* unit) {
  if (h.min_overlap > 0.0) return fmt::format("{:g} % of what counts (D-A15)", 100 * h.min_overlap);
  return fmt::format("{:g} {}", h.min_occupied, unit);
}

std::string surroundingsText(const OctreeMapConfig& octree, bool simulated) {
  std::string text = octree.outside == VoxelState::Free ? "free" : "unknown";
  if (!simulated) return text + "; free where a recorded camera has been";
  return text + (octree.known_scene ? "; boxes of the scene (table, walls, furniture) known"
                                    : "; nothing of the scene known");
}

}  // namespace

std::vector<DefaultUsed> defaultsUsed(const Settings& settings, const std::string& where, bool simulated) {
  constexpr double kDegree = std::numbers::pi / 180;
  const HierarchicalPlannerConfig& h = settings.exploration.hierarchical;
  const OccupancyConfig& o = settings.exploration.octree.occupancy;
  const char* unit = h.count == GainCount::Voxels ? "voxels" : "rays";
  std::vector<DefaultUsed> defaults = {
      {"candidates", candidatesText(settings.exploration),
       "320 and 1500 are the paper's; radius: released example", ""},
      {"aperture a_h x a_v",
       fmt::format("{:.3g} x {:.3g} deg", h.sensor.horizontal_fov_rad / kDegree,
                   h.sensor.vertical_fov_rad / kDegree),
       "Kinect", ""},
      {"range d_min, d", fmt::format("{:g}, {:g} m", h.sensor.min_range_m, h.sensor.max_range_m),
       "released example", ""},
      {"coarse levels m", number(h.coarse_levels), "gains degrade for m >= 3 (section 10.4)", ""},
      {"least known surface h_oc", surfaceText(h, unit), "400 rays: 50 cm2 face-on at 1 m", ""},
      {"stop threshold h_stop", number(h.stop_gain) + " " + unit, "library default of the released code", ""},
      {"robot box RBB", number(h.body_m) + " m", "released example", ""},
      {"hit / miss probability", fmt::format("{:g} / {:g}", o.hit_probability, o.miss_probability),
       "OctoMap's defaults", ""},
      {"clamping", fmt::format("{:g} .. {:g}", o.clamp_min, o.clamp_max), "OctoMap's defaults", ""},
      {"unknown band", fmt::format("[{:g}, {:g})", o.unknown_low, o.unknown_high), "released code (D-A7)",
       ""},
      {"inner nodes", o.inner == InnerRule::Max ? "max" : "mean", "D-A5", ""},
      {"around the object's box", surroundingsText(settings.exploration.octree, simulated), "D-A10", ""},
      {"children of rays", h.child_start == ChildStart::Resume ? "resume" : "restart", "D-A11", ""},
      {"rotation weight w", number(h.rotation_weight_m_per_rad) + " m/rad", "D-A17", ""},
      {"range of insertion", number(o.insert_range_m) + " m", "released example", ""},
      {"most planning steps", number(settings.exploration.steps), "the paper needed 10 to 15", ""},
  };
  for (DefaultUsed& used : defaults) used.where = where;
  return defaults;
}

void setDefault(std::vector<DefaultUsed>& defaults, const std::string& name, const std::string& value) {
  const auto found =
      std::ranges::find_if(defaults, [&](const DefaultUsed& used) { return used.name == name; });
  if (found == defaults.end()) throw std::logic_error("no default is called " + name);
  found->value = value;
}

DefaultUsed sizesUsed(const std::vector<std::pair<ObjectSource, double>>& objects, const std::string& where) {
  std::vector<std::string> sizes;
  for (const auto& [source, size_m] : objects) {
    const std::string text = number(size_m) + " m";
    if (std::ranges::find(sizes, text) == sizes.end()) sizes.push_back(text);
  }
  return {"object sizes", fmt::format("{}", fmt::join(sizes, ", ")), "the paper gives none", where};
}

}  // namespace vantage::experiments
