// Section 10 of the contour-based specification: what the paper does not give.
#include <fmt/format.h>

#include <numbers>

#include "io/config_file.h"
#include "viewer/app/experiments/experiments.h"

namespace vantage::experiments {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

std::string cm(double metres) {
  return fmt::format("{:g} cm", 100 * metres);
}
std::string degrees(double radians) {
  return fmt::format("{:.3g} deg", radians / kDegree);
}
const char* onOff(bool on) {
  return on ? "on" : "off";
}

std::vector<DefaultUsed> mapDefaults(const ExplorationConfig& e) {
  const Eigen::Vector3i& size = e.volume.size;
  return {
      {"truncation", cm(e.fusion.truncation_m), "PCL's default", ""},
      {"weight cap", fmt::format("{}", e.fusion.max_weight), "released code and PCL", ""},
      {"mapped volume", fmt::format("{} x {} x {} voxels", size.x(), size.y(), size.z()),
       "holds the workspace and the air in which the sensor moves", ""},
      {"height of the workspace", fmt::format("{:g} m", e.workspace.sizes().z()), "not given", ""},
      {"initial scan",
       fmt::format("{} frames on an arc of {:g} m, {:g} m away, {} up", e.scan.initial_frames,
                   e.scan.initial_arc_m, e.scan.initial_distance_m, degrees(e.scan.initial_elevation_rad)),
       "D-B28", ""},
      {"frames of a view", fmt::format("{}, tilted by {}", e.scan.frames, degrees(e.scan.tilt_rad)),
       "makes voxels known and their weights saturate (D-B27)", ""}};
}

std::vector<DefaultUsed> segmentDefaults(const SegmentationConfig& s) {
  return {
      {"VCCS voxel, seed", fmt::format("{:g} mm, {}", 1e3 * s.voxel_m, cm(s.seed_m)), "PCL's LCCP example",
       ""},
      {"spatial, normal weight", fmt::format("{:g}, {:g}", s.spatial_weight, s.normal_weight),
       "PCL's LCCP example", ""},
      {"concavity tolerance", degrees(s.concavity_tolerance_rad), "PCL's LCCP example", ""},
      {"smoothness", fmt::format("{:g}, check {}", s.smoothness, onOff(s.smoothness_check)),
       "PCL's LCCP example", ""},
      {"k-convexity, sanity, least segment",
       fmt::format("{}, {}, {} supervoxels", s.k_convexity, onOff(s.sanity_check), s.min_segment_supervoxels),
       "objects merge with the table otherwise (D-B34)", ""}};
}

std::vector<DefaultUsed> viewDefaults(const ContourPlannerConfig& c) {
  return {
      {"grouping D_th, A_th",
       fmt::format("{}, {}", cm(c.contours.group_distance_m), degrees(c.contours.group_angle_rad)),
       "spacing as in the paper's Table 2", ""},
      {"tilt of four directions", degrees(c.views.tilt_rad), "\"15 deg\" read as the half angle (D-B6)", ""},
      {"gain threshold", fmt::format("{:g} px", c.gain.gain_threshold),
       "a patch of 6 x 6 cm at 0.8 m (D-B12)", ""},
      {"gain cast at", fmt::format("1/{} of the resolution", c.gain.reduction), "D-B11", ""}};
}

std::vector<DefaultUsed> sensorDefaults(const Settings& settings) {
  const PinholeCamera& k = settings.camera;
  return {{"camera", fmt::format("{} x {}, f {:g}", k.width, k.height, k.fx), "gives 70 x 60 deg", ""},
          {"range", fmt::format("{:g} .. {:g} m", k.min_range_m, k.max_range_m), "Kinect V2, nominal", ""},
          {"noise at 1 m", fmt::format("{:g} mm", 1e3 * settings.sensor.noise_at_1m_m),
           "grows with depth squared", ""}};
}

}  // namespace

std::vector<DefaultUsed> contourDefaultsUsed(const Settings& settings, const std::string& where) {
  const ExplorationConfig& exploration = settings.exploration;
  std::vector<DefaultUsed> all;
  for (auto part : {mapDefaults(exploration), viewDefaults(exploration.contour),
                    segmentDefaults(exploration.contour.segmentation), sensorDefaults(settings)})
    for (DefaultUsed& used : part) {
      used.where = where;
      all.push_back(std::move(used));
    }
  return all;
}

std::vector<DefaultUsed> filterDefaultsUsed(const DepthFilterConfig& filter, const std::string& where) {
  return {{"bilateral filter",
           fmt::format("{} px, sigma {:g} px and {:g} mm", filter.bilateral_diameter_px,
                       filter.bilateral_sigma_px, 1e3 * filter.bilateral_sigma_m),
           "the driver's is not public", where},
          {"stand-in for the edge-aware filter",
           fmt::format("step {:g} of the depth, side {:g} of the step", filter.edge_step_share,
                       filter.edge_side_share),
           "the driver's is not public", where}};
}

}  // namespace vantage::experiments
