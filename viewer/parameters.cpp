#include "viewer/parameters.h"

#include <utility>

namespace vantage {
namespace {

/// Text entered or chosen instead of moved.
Parameter plain(std::string key, std::string label, std::optional<double> paper = {}) {
  Parameter p;
  p.key = std::move(key);
  p.label = std::move(label);
  p.paper = paper;
  return p;
}

Parameter slider(std::string key, std::string symbol, std::string label, std::string unit, double per_unit,
                 double low, double high, double step, std::optional<double> paper = {}) {
  Parameter p = plain(std::move(key), std::move(label), paper);
  p.symbol = std::move(symbol);
  p.unit = std::move(unit);
  p.per_unit = per_unit;
  p.low = low;
  p.high = high;
  p.step = step;
  return p;
}

Parameter inUnit(std::string unit, Parameter p) {
  p.unit = std::move(unit);
  return p;
}

Parameter logarithmic(Parameter p) {
  p.logarithmic = true;
  return p;
}

constexpr double kMm = 1e-3, kCm = 1e-2;

ParameterGroup thresholds(bool segments) {
  ParameterGroup group{"Thresholds (re-rank at once)", {}};
  auto& list = group.parameters;
  if (segments) {
    list.push_back(logarithmic(slider("saliency.isolation_distance_m", "B_th", "isolation distance", "mm",
                                      kMm, 0.002, 0.2, 0.0005, 0.02)));
    list.push_back(slider("gain.sphere_margin_m", "", "sphere margin", "cm", kCm, 0.0, 0.5, 0.01, 0.2));
  }
  list.push_back(slider("gain.threshold", "", "gain threshold", "rays or voxels", 1.0, 0.0, 20000.0, 10.0));
  if (segments) {
    list.push_back(slider("saliency.min_points", "", "points of a segment, at least", "", 1.0, 1, 500, 1));
    list.push_back(plain("saliency.use_isolation", "isolation counts"));
    list.push_back(plain("saliency.use_roundness", "roundness counts"));
  }
  list.push_back(plain("gain.exclude_executed", "leave out views taken before"));
  list.push_back(
      slider("gain.executed_distance_m", "", "distance to a taken view", "cm", kCm, 0.0, 0.5, 0.01));
  list.push_back(slider("gain.executed_angle_deg", "", "angle to a taken view", "deg", 1.0, 0.0, 90.0, 1.0));
  return group;
}

std::vector<ParameterGroup> contourParameters(bool segments) {
  std::vector<ParameterGroup> groups = {thresholds(segments)};
  groups.push_back(
      {"Contours",
       {slider("contours.weight_threshold", "W_th", "known from observations", "", 1.0, 1, 20, 1, 5),
        slider("contours.group_distance_m", "D_th", "reach of a group", "mm", kMm, 0.002, 0.1, 0.001),
        slider("contours.group_angle_deg", "A_th", "normals within", "deg", 1.0, 1, 90, 1),
        plain("contours.occupied_six_neighbours", "6 neighbours for occupied"),
        plain("contours.unknown_eighteen_neighbours", "18 neighbours for unknown"),
        plain("contours.normal", "normal that views look against")}});
  if (segments)
    groups.push_back(
        {"Segmentation",
         {slider("segmentation.voxel_m", "", "VCCS voxel", "mm", kMm, 0.003, 0.03, 0.0005),
          slider("segmentation.seed_m", "", "VCCS seeds", "mm", kMm, 0.01, 0.15, 0.001),
          slider("segmentation.spatial_weight", "", "weight of distance", "", 1.0, 0, 10, 0.1),
          slider("segmentation.normal_weight", "", "weight of normals", "", 1.0, 0, 10, 0.1),
          slider("segmentation.concavity_tolerance_deg", "", "concavity tolerance", "deg", 1.0, 0, 60, 1),
          plain("segmentation.smoothness_check", "smoothness check"),
          slider("segmentation.smoothness", "", "smoothness", "", 1.0, 0, 1, 0.01),
          slider("segmentation.k_convexity", "", "k-convexity", "", 1.0, 0, 3, 1),
          plain("segmentation.sanity_check", "sanity check"),
          slider("saliency.max_distance_m", "", "distances kept up to", "cm", kCm, 0.01, 0.5, 0.01),
          slider("segmentation.min_segment_supervoxels", "", "smallest segment, supervoxels", "", 1.0, 0, 30,
                 1)}});
  groups.push_back(
      {"Views",
       {inUnit("m", plain("views.distances_m", "distances", 0.8)),
        slider("views.tilt_deg", "", "tilt of directions", "deg", 1.0, 0, 45, 0.5, 15),
        slider("views.rolls", "", "rolls", "", 1.0, 1, 16, 1, 8),
        slider("gain.reduction", "", "rays: 1/n of the resolution", "", 1.0, 1, 16, 1),
        plain("gain.count", "what is counted"), plain("gain.outside", "unknown outside the sphere")}});
  return groups;
}

std::vector<ParameterGroup> octreeParameters(bool coarse) {
  ParameterGroup thresholds{
      "Thresholds (re-rank at once)",
      {slider("utility.min_occupied", "h_oc", "known surface, at least", "rays", 1.0, 0, 10000, 10),
       slider("utility.min_overlap", "", "least share of known surface", "%", 0.01, 0, 1, 0.01),
       slider("utility.stop_gain", "h_stop", "unknown in view, at least", "rays", 1.0, 0, 10000, 10),
       slider("utility.rotation_weight_m_per_rad", "w", "cost of turning one radian", "m", 1.0, 0, 5, 0.05)}};
  ParameterGroup rays{
      "Rays",
      {slider("rays.horizontal_fov_deg", "a_h", "aperture, horizontal", "deg", 1.0, 10, 120, 1),
       slider("rays.vertical_fov_deg", "a_v", "aperture, vertical", "deg", 1.0, 10, 120, 1),
       slider("rays.min_range_m", "d_min", "nearest", "m", 1.0, 0, 2, 0.05),
       slider("rays.max_range_m", "d", "depth of view", "m", 1.0, 0.5, 6, 0.05),
       plain("rays.anchor", "place of the grid"), plain("rays.child_start", "refined rays begin"),
       plain("rays.refine_unknown", "refine unknown"), plain("rays.count", "what is counted")}};
  if (coarse)
    rays.parameters.insert(rays.parameters.begin(),
                           slider("rays.coarse_levels", "m", "coarse levels", "", 1.0, 0, 4, 1));
  ParameterGroup candidates{
      "Candidates",
      {plain("candidates.generator", "generator"),
       slider("candidates.subdivisions", "", "subdivisions of the sphere", "", 1.0, 0, 4, 1, 2),
       slider("candidates.radius_m", "", "radius of the sphere", "m", 1.0, 0.2, 3, 0.05),
       slider("candidates.workspace_views", "", "views in the workspace", "", 1.0, 0, 5000, 100, 1500),
       slider("utility.body_m", "RBB", "robot's cube", "cm", kCm, 0, 0.3, 0.01),
       plain("utility.exclude_executed", "leave out views taken before"),
       slider("utility.executed_distance_m", "", "distance to a taken view", "cm", kCm, 0, 0.5, 0.01),
       slider("utility.executed_angle_deg", "", "angle to a taken view", "deg", 1.0, 0, 90, 1)}};
  return {std::move(thresholds), std::move(rays), std::move(candidates)};
}

/// Null if the planner does not have it.
const Parameter* parameterOf(PlannerKind planner, const std::string& key) {
  for (const ParameterGroup& group : parametersOf(planner))
    for (const Parameter& parameter : group.parameters)
      if (parameter.key == key) return &parameter;
  return nullptr;
}

}  // namespace

const std::vector<ParameterGroup>& parametersOf(PlannerKind planner) {
  static const std::vector<ParameterGroup> contour = contourParameters(true),
                                           standard = contourParameters(false),
                                           hierarchical = octreeParameters(true),
                                           uniform = octreeParameters(false);
  switch (planner) {
    case PlannerKind::Contour:
      return contour;
    case PlannerKind::Standard:
      return standard;
    case PlannerKind::Hierarchical:
      return hierarchical;
    case PlannerKind::Uniform:
      return uniform;
  }
  return contour;
}

bool isParameterOf(PlannerKind planner, const std::string& key) {
  return parameterOf(planner, key) != nullptr;
}

const Parameter* parameterOf(const std::string& key) {
  for (const PlannerKind planner : kPlannerKinds)
    if (const Parameter* parameter = parameterOf(planner, key)) return parameter;
  return nullptr;
}

}  // namespace vantage
