#include "io/config_field_makers.h"

// What the hierarchical planner adds. "A section" is a section of its specification, "D-A7" one of its
// decisions.

namespace vantage::config {

std::vector<Field> octreeFields() {
  return {
      number("octree.voxel_size_m", "l, edge of a finest voxel, metres (A section 8)", 1e-3, 1,
             AT(exploration.octree.voxel_size_m)),
      vector3(
          "octree.object_min_m",
          "lower corner of the object's box, metres; a box without volume = the workspace (A section 1)",
          Kind::Numbers, -1000, 1000, [](auto& s) -> auto& { return s.exploration.octree.object_box.min(); }),
      vector3(
          "octree.object_max_m", "upper corner of the object's box, metres", Kind::Numbers, -1000, 1000,
          [](auto& s) -> auto& { return s.exploration.octree.object_box.max(); }),
      choice<VoxelState>("octree.outside", "what is around the object's box at the start (D-A10)",
                         {{"free", VoxelState::Free}, {"unknown", VoxelState::Unknown}},
                         AT(exploration.octree.outside)),
      flag("octree.known_scene",
           "simulation: table, panel and room are in the map from the start (A section 10.4)",
           AT(exploration.octree.known_scene)),
      number("octree.hit_probability", "of a voxel in which a measurement ends (A section 8)", 0.501, 0.999,
             AT(exploration.octree.occupancy.hit_probability)),
      number("octree.miss_probability", "of a voxel that a ray passes (A section 8)", 0.001, 0.499,
             AT(exploration.octree.occupancy.miss_probability)),
      number("octree.clamp_min", "probabilities stay above (A section 8)", 0.001, 0.499,
             AT(exploration.octree.occupancy.clamp_min)),
      number("octree.clamp_max", "probabilities stay below (A section 8)", 0.501, 0.999,
             AT(exploration.octree.occupancy.clamp_max)),
      number("octree.unknown_low", "below it a voxel is free (D-A7)", 0.001, 0.5,
             AT(exploration.octree.occupancy.unknown_low)),
      number("octree.unknown_high", "from here on it is occupied (D-A7)", 0.5, 0.999,
             AT(exploration.octree.occupancy.unknown_high)),
      number("octree.insert_range_m",
             "measurements beyond only clear the way up to here, metres (A section 8)", 0.01, 1000,
             AT(exploration.octree.occupancy.insert_range_m)),
      choice<InnerRule>("octree.inner", "label of a coarse node: maximum or mean of its voxels (D-A5)",
                        {{"max", InnerRule::Max}, {"mean", InnerRule::Mean}},
                        AT(exploration.octree.occupancy.inner)),
  };
}

std::vector<Field> hierarchicalFields() {
  return {
      angle("rays.horizontal_fov_deg", "a_h, full aperture of the planned sensor, degrees (A section 8)", 1,
            179, AT(exploration.hierarchical.sensor.horizontal_fov_rad)),
      angle("rays.vertical_fov_deg", "a_v, full aperture of the planned sensor, degrees (A section 8)", 1,
            179, AT(exploration.hierarchical.sensor.vertical_fov_rad)),
      number("rays.min_range_m", "hits nearer than this are lost, metres (D-A22)", 0, 1000,
             AT(exploration.hierarchical.sensor.min_range_m)),
      number("rays.max_range_m", "d, depth of view, metres, above the nearest (A section 8)", 0.01, 1000,
             AT(exploration.hierarchical.sensor.max_range_m)),
      choice<RayAnchor>("rays.anchor", "where the grid of rays lies in the aperture (D-A1)",
                        {{"centered", RayAnchor::Centered}, {"literal", RayAnchor::Literal}},
                        AT(exploration.hierarchical.sensor.anchor)),
      integer("rays.coarse_levels", "m, levels above the finest at which tracing starts (A section 6)", 0, 8,
              AT(exploration.hierarchical.coarse_levels)),
      choice<ChildStart>("rays.child_start",
                         "refined rays begin at their parent's hit or at the sensor (D-A11)",
                         {{"resume", ChildStart::Resume}, {"restart", ChildStart::Restart}},
                         AT(exploration.hierarchical.child_start)),
      flag("rays.refine_unknown", "unknown nodes are refined too (D-A4)",
           AT(exploration.hierarchical.refine_unknown)),
      choice<GainCount>("rays.count", "what is counted (D-A4)",
                        {{"rays", GainCount::Rays}, {"voxels", GainCount::Voxels}},
                        AT(exploration.hierarchical.count)),
      choice<CandidateGenerator>(
          "candidates.generator", "where candidate views come from (A section 7)",
          {{"icosphere", CandidateGenerator::Icosphere}, {"workspace", CandidateGenerator::Workspace}},
          AT(exploration.hierarchical.generator)),
      integer("candidates.subdivisions", "of the icosphere: 20 * 4^n views (D-A21)", 0, 6,
              AT(exploration.hierarchical.icosphere_subdivisions)),
      number("candidates.radius_m", "of the icosphere about the object's box, metres (A section 8)", 0.01,
             100, AT(exploration.hierarchical.sphere_radius_m)),
      integer("candidates.workspace_views", "drawn uniformly in the mapped volume (A section 8)", 0, 1000000,
              AT(exploration.hierarchical.workspace_views)),
      flag("candidates.recorded", "recorded data: the poses that are left are candidates too",
           AT(exploration.recorded_candidates)),
      number("utility.body_m", "RBB, edge of the robot's cube, metres (D-A16)", 0, 10,
             AT(exploration.hierarchical.body_m)),
      number("utility.min_occupied", "h_oc, least known surface in view, rays (eq. 2)", 0, 1e9,
             AT(exploration.hierarchical.min_occupied)),
      number("utility.min_overlap", "instead: least share of known surface, 0 = h_oc counts (D-A15)", 0, 1,
             AT(exploration.hierarchical.min_overlap)),
      number("utility.stop_gain", "h_stop, least unknown in view, rays (D-A18)", 0, 1e9,
             AT(exploration.hierarchical.stop_gain)),
      flag("utility.exclude_executed", "views near one already taken are not offered again",
           AT(exploration.hierarchical.exclude_executed)),
      number("utility.executed_distance_m", "how near, metres", 0, 1000,
             AT(exploration.hierarchical.executed_distance_m)),
      angle("utility.executed_angle_deg", "and how little turned, degrees", 0, 180,
            AT(exploration.hierarchical.executed_angle_rad)),
      number("utility.rotation_weight_m_per_rad", "w, metres of distance a radian of rotation (D-A17)", 0,
             1000, AT(exploration.hierarchical.rotation_weight_m_per_rad)),
  };
}

}  // namespace vantage::config
