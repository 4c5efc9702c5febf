#include "io/config_field_makers.h"

// The list of everything that can be configured: key, meaning with unit and source, range, and where it
// lives. "section" is a section of the contour planner's specification, "D-B7" one of its decisions.

namespace vantage::config {
namespace {

/// The planners of a run (core/exploration/planner_kind.h).
Field plannerNames(const char* key, const char* doc) {
  Field field = base(key, doc, Kind::Names);
  for (const PlannerKind kind : kPlannerKinds) field.choices.emplace_back(toString(kind));
  field.get = [](const Settings& s) -> Value { return plannersToText(s.exploration.planners); };
  field.set = [](Settings& s, const Value& v) {
    s.exploration.planners = plannersFromText(std::get<std::string>(v));
  };
  return field;
}

std::vector<Field> explorationFields() {
  return {
      plannerNames("exploration.planner",
                   "how views are chosen: one planner, or one for each view in turn, the last goes on"),
      integer("exploration.steps", "next best views per run (section 10)", 0, 10000, AT(exploration.steps)),
      integer("exploration.seed", "of noise and path planning", 0, 9007199254740992.0, AT(exploration.seed)),
      flag("exploration.enforce_reachability", "false: obstacles and paths are only reported (recorded data)",
           AT(exploration.enforce_reachability)),
      integer("scan.initial_frames", "frames of the initial scan (D-B28)", 1, 10000,
              AT(exploration.scan.initial_frames)),
      number("scan.initial_arc_m", "length of the initial arc, metres (D-B28)", 0, 100,
             AT(exploration.scan.initial_arc_m)),
      number("scan.initial_distance_m", "initial distance to the scene centre, metres (D-B28)", 0.01, 100,
             AT(exploration.scan.initial_distance_m)),
      angle("scan.initial_elevation_deg", "elevation of the initial arc, degrees (D-B28)", -90, 90,
            AT(exploration.scan.initial_elevation_rad)),
      angle("scan.initial_azimuth_deg", "middle of the initial arc, degrees from +x (D-B28)", -360, 360,
            AT(exploration.scan.initial_azimuth_rad)),
      vector3("scan.scene_center_m", "point the initial scan looks at, world, metres (D-B28)", Kind::Numbers,
              -1000, 1000, AT(exploration.scan.scene_center_m)),
      number("scan.clear_radius_m", "space around the sensor taken as empty at the start, metres (D-B28)", 0,
             10, AT(exploration.scan.clear_radius_m)),
      integer("scan.frames", "frames fused at each view (D-B27)", 1, 10000, AT(exploration.scan.frames)),
      angle("scan.tilt_deg", "amplitude of the tilt at each view, degrees (D-B27)", 0, 45,
            AT(exploration.scan.tilt_rad)),
  };
}

std::vector<Field> cameraFields() {
  return {
      integer("camera.width", "image width, pixels (Kinect V2, section 10)", 1, 8192, AT(camera.width)),
      integer("camera.height", "image height, pixels", 1, 8192, AT(camera.height)),
      number("camera.fx", "focal length, pixels", 1e-3, 1e6, AT(camera.fx)),
      number("camera.fy", "focal length, pixels", 1e-3, 1e6, AT(camera.fy)),
      number("camera.cx", "principal point, pixels, 0 = centre of the first pixel", -1e6, 1e6, AT(camera.cx)),
      number("camera.cy", "principal point, pixels", -1e6, 1e6, AT(camera.cy)),
      number("camera.min_range_m", "nearest measurable depth, metres", 0, 1000, AT(camera.min_range_m)),
      number("camera.max_range_m", "farthest measurable depth, metres, above the nearest", 1e-3, 10000,
             AT(camera.max_range_m)),
      number("camera.noise_at_1m_m", "simulated: standard deviation at 1 m, metres, grows with depth squared",
             0, 1, AT(sensor.noise_at_1m_m)),
      flag("camera.emitter_shadow", "simulated: pixels that the emitter does not light are invalid",
           AT(sensor.emitter_shadow)),
      flag("camera.faults",
           "simulated: wrong depth where the emitter does not light and veils at depth steps, as a Kinect V2",
           AT(sensor.faults)),
      number("camera.emitter_offset_m", "simulated: emitter to the left of the camera, metres (D-B20)", -1, 1,
             AT(sensor.emitter_offset_m)),
  };
}

/// Section 9. Off by default: the simulated sensor has no faults unless it is told to.
std::vector<Field> filterFields() {
  return {
      flag("filter.bilateral", "smooth depth, steps are kept", AT(exploration.filter.bilateral)),
      integer("filter.bilateral_diameter_px", "window of that, pixels", 1, 31,
              AT(exploration.filter.bilateral_diameter_px)),
      number("filter.bilateral_sigma_px", "weight by distance in the image, pixels", 0.1, 20,
             AT(exploration.filter.bilateral_sigma_px)),
      number("filter.bilateral_sigma_m", "weight by difference of depth, metres", 0.001, 1,
             AT(exploration.filter.bilateral_sigma_m)),
      flag("filter.shadow", "remove what the emitter may not light (Algorithm 2)",
           AT(exploration.filter.shadow)),
      number("filter.emitter_offset_m", "Delta, distance of camera and emitter, metres (section 10)", 0.001,
             1, AT(exploration.filter.emitter_offset_m)),
      choice<EmitterSide>("filter.emitter_side", "where the emitter stands, seen along the axis (D-B20)",
                          {{"left", EmitterSide::Left}, {"right", EmitterSide::Right}},
                          AT(exploration.filter.emitter_side)),
      flag("filter.veil", "remove what is seen at a grazing angle (eq. 19)", AT(exploration.filter.veil)),
      angle("filter.veil_angle_deg", "Theta_max of that, degrees (section 10)", 0.1, 85,
            AT(exploration.filter.veil_angle_rad)),
      flag("filter.edge_aware", "stand-in for the driver's filter: remove what hangs between two sides",
           AT(exploration.filter.edge_aware)),
      number("filter.edge_step_share", "smallest step of that, share of the depth", 0.001, 1,
             AT(exploration.filter.edge_step_share)),
      number("filter.edge_side_share", "what is nearer to a side than this share of the step belongs to it",
             0, 0.5, AT(exploration.filter.edge_side_share)),
  };
}

std::vector<Field> mapFields() {
  return {
      vector3("volume.origin_m", "centre of voxel (0,0,0), world, metres (section 10)", Kind::Numbers, -1000,
              1000, AT(exploration.volume.origin_m)),
      number("volume.voxel_size_m", "edge of a voxel, metres (section 10)", 1e-4, 10,
             AT(exploration.volume.voxel_size_m)),
      vector3("volume.size", "voxels along x, y, z", Kind::Integers, 2, 8192, AT(exploration.volume.size)),
      vector3(
          "workspace.min_m",
          "lower corner of the box that limits the baseline's gain and the metrics, metres", Kind::Numbers,
          -1000, 1000, [](auto& s) -> auto& { return s.exploration.workspace.min(); }),
      vector3(
          "workspace.max_m", "upper corner of that box, metres", Kind::Numbers, -1000, 1000,
          [](auto& s) -> auto& { return s.exploration.workspace.max(); }),
      number("fusion.truncation_m",
             "truncation of the signed distance, metres, at least 2.1 voxels (section 3)", 1e-4, 100,
             AT(exploration.fusion.truncation_m)),
      integer("fusion.max_weight", "observations at which a voxel's weight saturates (section 10)", 1, 60000,
              AT(exploration.fusion.max_weight)),
      integer("fusion.observations_per_frame", "what one frame counts for; 10 for recorded stops", 1, 60000,
              AT(exploration.fusion.observations_per_frame)),
      vector3("dataset.position_m", "placement of recorded data in the world, metres", Kind::Numbers, -10000,
              10000, AT(dataset_position_m)),
      quaternion("dataset.quaternion_xyzw", "placement of recorded data in the world, unit quaternion",
                 AT(dataset_orientation)),
      number("dataset.serve_distance_m",
             "recorded data: a view needs a frame this near, metres, 0 = the nearest serves", 0, 1000,
             AT(exploration.serve_distance_m)),
      angle("dataset.serve_angle_deg", "and turned by no more than this, degrees", 0, 180,
            AT(exploration.serve_angle_rad)),
  };
}

std::vector<Field> plannerFields() {
  return {
      integer("contours.weight_threshold", "W_th, observations from which a voxel is known (section 4)", 1,
              1000, AT(exploration.contour.contours.weight_threshold)),
      number("contours.group_distance_m", "D_th, reach of a group of contour voxels, metres (section 4)",
             1e-6, 10, AT(exploration.contour.contours.group_distance_m)),
      angle("contours.group_angle_deg", "A_th, normals of a group differ by less, degrees (D-B3)", 1e-6, 180,
            AT(exploration.contour.contours.group_angle_rad)),
      flag("contours.occupied_six_neighbours", "ablation: 6 neighbours instead of 18 for occupied (D-B1)",
           AT(exploration.contour.contours.occupied_six_neighbours)),
      flag("contours.unknown_eighteen_neighbours", "ablation: 18 neighbours instead of 6 for unknown (D-B1)",
           AT(exploration.contour.contours.unknown_eighteen_neighbours)),
      choice<ContourNormal>("contours.normal",
                            "against which views look: the frontier's, or (ablation) the surface's (D-B5)",
                            {{"frontier", ContourNormal::Frontier}, {"surface", ContourNormal::Surface}},
                            AT(exploration.contour.contours.normal)),
      list("views.distances_m", "sensor to contour point, metres (section 5)", 0.01, 100, 16,
           AT(exploration.contour.views.distances_m)),
      angle("views.tilt_deg", "four extra directions from the normal, degrees (D-B6)", 0, 90,
            AT(exploration.contour.views.tilt_rad)),
      integer("views.rolls", "equal steps of a full turn about the axis (section 5)", 1, 64,
              AT(exploration.contour.views.rolls)),
      number("segmentation.voxel_m", "VCCS voxel, metres (D-B34)", 1e-4, 10,
             AT(exploration.contour.segmentation.voxel_m)),
      number("segmentation.seed_m", "VCCS seed spacing, metres, above the voxel (D-B34)", 1e-4, 10,
             AT(exploration.contour.segmentation.seed_m)),
      number("segmentation.spatial_weight", "VCCS weight of distance (D-B34)", 0, 1000,
             AT(exploration.contour.segmentation.spatial_weight)),
      number("segmentation.normal_weight", "VCCS weight of normals (D-B34)", 0, 1000,
             AT(exploration.contour.segmentation.normal_weight)),
      angle("segmentation.concavity_tolerance_deg", "LCCP, degrees (D-B34)", 0, 180,
            AT(exploration.contour.segmentation.concavity_tolerance_rad)),
      flag("segmentation.smoothness_check", "LCCP: steps between patches separate (D-B34)",
           AT(exploration.contour.segmentation.smoothness_check)),
      number("segmentation.smoothness", "LCCP: step allowed, share of the seed spacing (D-B34)", 0, 100,
             AT(exploration.contour.segmentation.smoothness)),
      integer("segmentation.k_convexity", "LCCP: common convex neighbours wanted (D-B34)", 0, 3,
              AT(exploration.contour.segmentation.k_convexity)),
      flag("segmentation.sanity_check", "LCCP: sanity criterion (D-B34)",
           AT(exploration.contour.segmentation.sanity_check)),
      integer("segmentation.min_segment_supervoxels",
              "segments up to this size join their largest neighbour, 0 = off (D-B34)", 0, 10000,
              AT(exploration.contour.segmentation.min_segment_supervoxels)),
      number("saliency.isolation_distance_m", "B_th, metres (section 7)", 1e-6, 0.2,
             AT(exploration.contour.saliency.isolation_distance_m)),
      number("saliency.max_distance_m", "distances to other segments are kept up to here, metres", 1e-3, 10,
             AT(exploration.contour.saliency.max_distance_m)),
      integer("saliency.min_points", "smaller segments have saliency 0 (D-B17)", 1, 1000000,
              AT(exploration.contour.saliency.min_points)),
      flag("saliency.use_isolation", "ablation if false: isolation is 1 (section 7)",
           AT(exploration.contour.saliency.use_isolation)),
      flag("saliency.use_roundness", "ablation if false: roundness is 1 (section 7)",
           AT(exploration.contour.saliency.use_roundness)),
  };
}

std::vector<Field> gainFields() {
  return {
      number("gain.sphere_margin_m", "added to the radius of a segment's sphere, metres (section 8)", 0, 100,
             AT(exploration.contour.gain.sphere_margin_m)),
      number("gain.threshold", "least gain of a view, rays at full resolution or voxels (D-B12)", 0, 1e9,
             AT(exploration.contour.gain.gain_threshold)),
      integer("gain.reduction", "rays are cast at 1/reduction of the resolution per axis (D-B11)", 1, 64,
              AT(exploration.contour.gain.reduction)),
      choice<GainMeasure>(
          "gain.count",
          "what a view gains: rays that end on unknown, the voxels that they end on, or (ablation) all "
          "unknown "
          "voxels before the first occupied one (D-B7, D-B8)",
          {{"rays", GainMeasure::Rays}, {"voxels", GainMeasure::Voxels}, {"volume", GainMeasure::Volume}},
          AT(exploration.contour.gain.count)),
      choice<OutsideUnknown>(
          "gain.outside", "unknown voxels outside the sphere end a ray or not (D-B9)",
          {{"opaque", OutsideUnknown::Opaque}, {"transparent", OutsideUnknown::Transparent}},
          AT(exploration.contour.gain.outside)),
      flag("gain.exclude_executed", "poses near one already taken are not offered again (D-B15)",
           AT(exploration.contour.gain.exclude_executed)),
      number("gain.executed_distance_m", "how near, metres (D-B15)", 0, 100,
             AT(exploration.contour.gain.executed_distance_m)),
      angle("gain.executed_angle_deg", "how near, degrees (D-B15)", 0, 180,
            AT(exploration.contour.gain.executed_angle_rad)),
      flag("gain.exclude_disappointing", "contours that delivered nothing are not offered again (D-B33)",
           AT(exploration.contour.gain.exclude_disappointing)),
      number("gain.disappointing_share", "realised / predicted gain below which a view disappoints (D-B33)",
             0, 1, AT(exploration.contour.gain.disappointing_share)),
      number("gain.disappointing_distance_m", "contour points this near are dropped, metres (D-B33)", 0, 100,
             AT(exploration.contour.gain.disappointing_distance_m)),
  };
}

std::vector<Field> robotFields() {
  return {
      number("robot.body_radius_m", "of the free-flying sensor, metres (D-B26)", 0, 10,
             AT(free_flyer.body_radius_m)),
      number("robot.cell_m", "collision cell, metres (section 10)", 1e-3, 10, AT(free_flyer.cell_m)),
      number("robot.reach_m", "radius of the ball the sensor stays in, metres, 0 = no limit (section 10)", 0,
             1000, AT(free_flyer.reach_m)),
      vector3("robot.reach_center_m", "centre of that ball, world, metres (section 10)", Kind::Numbers, -1000,
              1000, AT(free_flyer.reach_center_m)),
      number("robot.min_height_m", "the sensor stays above, world z, metres", -1000, 1000,
             AT(free_flyer.min_height_m)),
      number("robot.check_step_m", "spacing of collision checks along a path, metres", 1e-4, 1,
             AT(free_flyer.check_step_m)),
      integer("robot.rrt_iterations", "of RRT-Connect, per query", 1, 10000000,
              AT(free_flyer.rrt_iterations)),
      number("robot.rrt_range_m", "longest edge of its trees, metres", 1e-3, 100, AT(free_flyer.rrt_range_m)),
      number("robot.safety_time_s", "wall clock after which a query is given up, seconds", 1e-3, 86400,
             AT(free_flyer.safety_time_s)),
      number("robot.speed_m_per_s", "of the simulated motion, metres a second", 1e-4, 100,
             AT(free_flyer.speed_m_per_s)),
  };
}

/// Boxes as six numbers each: lower corner, upper corner.
Field clearBoxes() {
  Field field = base("arm.clear_boxes_m",
                     "boxes x0,y0,z0,x1,y1,z1 that are vouched to hold nothing but the arm, world, metres",
                     Kind::Numbers, -1000, 1000);
  field.max_count = 600;
  field.get = [](const Settings& s) -> Value {
    std::vector<double> numbers;
    for (const Box& box : s.arm.clear_boxes) {
      numbers.insert(numbers.end(), box.min().begin(), box.min().end());
      numbers.insert(numbers.end(), box.max().begin(), box.max().end());
    }
    return numbers;
  };
  field.set = [](Settings& s, const Value& value) {
    const auto& numbers = std::get<std::vector<double>>(value);
    if (numbers.size() % 6 != 0)
      throw std::invalid_argument("arm.clear_boxes_m has " + std::to_string(numbers.size()) +
                                  " numbers; a box takes six: x0, y0, z0, x1, y1, z1");
    s.arm.clear_boxes.clear();
    for (std::size_t n = 0; n < numbers.size(); n += 6)
      s.arm.clear_boxes.emplace_back(Eigen::Vector3d(numbers[n], numbers[n + 1], numbers[n + 2]),
                                     Eigen::Vector3d(numbers[n + 3], numbers[n + 4], numbers[n + 5]));
  };
  return field;
}

Field startJoints() {
  Field field = base("arm.start_deg", "joints at the start, one number each; none = a start is looked for",
                     Kind::Numbers, -36000, 36000);
  field.max_count = kMaxArmJoints;
  field.get = [](const Settings& s) -> Value {
    std::vector<double> values;
    for (const double q : s.arm.start_rad) values.push_back(degrees(q));
    return values;
  };
  field.set = [](Settings& s, const Value& value) {
    s.arm.start_rad.clear();
    for (const double q : std::get<std::vector<double>>(value)) s.arm.start_rad.push_back(radians(q));
  };
  return field;
}

std::vector<Field> armFields() {
  return {
      vector3("arm.base_m", "where the arm stands, world, metres (evaluation.md, B1)", Kind::Numbers, -1000,
              1000, AT(arm.base_m)),
      angle("arm.base_yaw_deg", "its turn about world z, degrees", -360, 360, AT(arm.base_yaw_rad)),
      clearBoxes(),
      startJoints(),
      angle("arm.start_arc_deg", "turn of the first joint during the initial scan, degrees", 0, 360,
            AT(arm.start_arc_rad)),
      integer("arm.goals", "free joint configurations of a view that are tried, nearest first", 1, 1000,
              AT(arm.path.goals)),
      angle("arm.rrt_range_deg", "longest edge of the search trees, degrees", 0.1, 3600,
            AT(arm.path.rrt_range_rad)),
      number("arm.speed_share", "of every joint's greatest velocity", 1e-3, 1, AT(arm.timing.speed_share)),
      number("arm.ramp_s", "from rest to that speed, seconds", 1e-3, 60, AT(arm.timing.ramp_s)),
      number("arm.period_s", "control period, seconds", 1e-3, 1, AT(arm.timing.period_s)),
      number("arm.body_margin_m", "the arm's bodies are as much thicker when depth images lose them, metres",
             0, 1, AT(arm.body_margin_m)),
      angle("arm.encoder_noise_deg", "simulated: standard deviation of every joint reading, degrees", 0, 57,
            AT(arm_errors.encoder_noise_rad)),
      number("arm.mount_error_m", "simulated: the camera truly sits as far from where it is believed, metres",
             0, 1, AT(arm_errors.mount_error_m)),
      angle("arm.mount_error_deg", "simulated: and is turned by as much, degrees", 0, 180,
            AT(arm_errors.mount_error_rad)),
  };
}

std::vector<Field> allFields() {
  std::vector<Field> all;
  for (auto* part : {explorationFields, cameraFields, filterFields, mapFields, plannerFields, gainFields,
                     octreeFields, hierarchicalFields, robotFields, armFields})
    for (Field& field : part()) all.push_back(std::move(field));
  return all;
}

}  // namespace

const std::vector<Field>& fields() {
  static const std::vector<Field> all = allFields();
  return all;
}

const Field* find(std::string_view key) {
  for (const Field& field : fields())
    if (field.key == key) return &field;
  return nullptr;
}

}  // namespace vantage::config
