#pragma once

#include "core/exploration/step_record.h"
#include "io/run_bytes.h"
#include "io/run_codec.h"
#include "io/run_file.h"

namespace vantage {

// Every field of every type that a run file holds, once, in the order in which it is stored. A change here is
// a new version of the file (kRunVersion).

template <>
inline constexpr std::int64_t kEnumCount<Stage> = static_cast<std::int64_t>(Stage::Realised) + 1;
template <>
inline constexpr std::int64_t kEnumCount<Reachability> = kReachabilityCount;
template <>
inline constexpr std::int64_t kEnumCount<ShapeKind> = 4;
template <>
inline constexpr std::int64_t kEnumCount<OutsideUnknown> = 2;
template <>
inline constexpr std::int64_t kEnumCount<ContourNormal> = 2;
template <>
inline constexpr std::int64_t kEnumCount<GainMeasure> = 3;
template <>
inline constexpr std::int64_t kEnumCount<VoxelState> = 3;
template <>
inline constexpr std::int64_t kEnumCount<InnerRule> = 2;
template <>
inline constexpr std::int64_t kEnumCount<RayAnchor> = 2;
template <>
inline constexpr std::int64_t kEnumCount<ChildStart> = 2;
template <>
inline constexpr std::int64_t kEnumCount<CandidateGenerator> = 2;
template <>
inline constexpr std::int64_t kEnumCount<GainCount> = 2;
template <>
inline constexpr std::int64_t kEnumCount<ViewRejection> = 4;
template <>
inline constexpr bool kFlat<ScanPose> = true;
template <>
inline constexpr bool kFlat<ContourVoxel> = true;
template <>
inline constexpr bool kFlat<ContourPoint> = true;
template <>
inline constexpr bool kFlat<Segment> = true;
template <>
inline constexpr bool kFlat<ViewPosition> = true;
template <>
inline constexpr bool kFlat<PoseScore> = true;
template <>
inline constexpr bool kFlat<RayCounts> = true;
template <>
inline constexpr bool kFlat<ViewUtility> = true;

// Geometry
void fields(auto& a, Like<PinholeCamera> auto& v) {
  a(v.width, v.height, v.fx, v.fy, v.cx, v.cy, v.min_range_m, v.max_range_m);
}
void fields(auto& a, Like<GridGeometry> auto& v) {
  a(v.origin_m, v.voxel_size_m, v.size);
}
void fields(auto& a, Like<Sphere> auto& v) {
  a(v.center, v.radius);
}
void fields(auto& a, Like<TriangleMesh> auto& v) {
  a(v.vertices, v.triangles, v.colors);
}
void fields(auto& a, Like<DepthImage> auto& v) {
  a(v.width, v.height, v.depth_m);
}

// Configuration
void fields(auto& a, Like<ContourConfig> auto& v) {
  a(v.weight_threshold, v.group_distance_m, v.group_angle_rad, v.occupied_six_neighbours,
    v.unknown_eighteen_neighbours);  // v.normal: ContourOptions
}
void fields(auto& a, Like<ContourViewConfig> auto& v) {
  a(v.distances_m, v.tilt_rad, v.rolls);
}
void fields(auto& a, Like<SegmentationConfig> auto& v) {
  a(v.voxel_m, v.seed_m, v.spatial_weight, v.normal_weight, v.concavity_tolerance_rad, v.smoothness_check,
    v.smoothness, v.k_convexity, v.sanity_check, v.min_segment_supervoxels);
}
void fields(auto& a, Like<SaliencyConfig> auto& v) {
  a(v.isolation_distance_m, v.max_distance_m, v.min_points, v.use_isolation, v.use_roundness);
}
void fields(auto& a, Like<GainConfig> auto& v) {
  a(v.sphere_margin_m, v.gain_threshold, v.reduction, v.outside, v.exclude_executed, v.executed_distance_m,
    v.executed_angle_rad, v.exclude_disappointing, v.disappointing_share, v.disappointing_distance_m);
  // v.count: ContourOptions
}
void fields(auto& a, Like<ContourPlannerConfig> auto& v) {
  a(v.contours, v.views, v.segmentation, v.saliency, v.gain, v.segment_by_segment);
}
void fields(auto& a, Like<RaySensor> auto& v) {
  a(v.horizontal_fov_rad, v.vertical_fov_rad, v.min_range_m, v.max_range_m, v.anchor);
}
void fields(auto& a, Like<HierarchicalPlannerConfig> auto& v) {
  a(v.sensor, v.coarse_levels, v.child_start, v.refine_unknown, v.count, v.generator,
    v.icosphere_subdivisions, v.sphere_radius_m, v.workspace_views, v.body_m, v.min_occupied, v.min_overlap,
    v.stop_gain, v.exclude_executed, v.executed_distance_m, v.executed_angle_rad,
    v.rotation_weight_m_per_rad);
}
void fields(auto& a, Like<OccupancyConfig> auto& v) {
  a(v.hit_probability, v.miss_probability, v.clamp_min, v.clamp_max, v.unknown_low, v.unknown_high,
    v.insert_range_m, v.inner);
}
void fields(auto& a, Like<OctreeMapConfig> auto& v) {
  a(v.voxel_size_m, v.object_box, v.outside, v.known_scene, v.occupancy);
}
void fields(auto& a, Like<FreeFlyerConfig> auto& v) {
  a(v.body_radius_m, v.cell_m, v.reach_m, v.reach_center_m, v.min_height_m, v.check_step_m, v.rrt_iterations,
    v.rrt_range_m, v.safety_time_s, v.speed_m_per_s);
}

/// How a run ended, and what it must hold then.
struct RunEnd {
  std::string stop_reason;
  std::vector<int> steps;
  bool closing = false;
};
void fields(auto& a, Like<RunEnd> auto& v) {
  a(v.stop_reason, v.steps, v.closing);
}

// The run; its true scene is a product of its own.
void fields(auto& a, Like<RunHeader> auto& v) {
  a(v.input, v.planner, v.robot, v.command_line, v.version, v.scene_toml, v.config_toml, v.seed, v.threads,
    v.compute, v.camera, v.volume, v.workspace, v.contour_config, v.free_flyer, v.replay);
}
/// Options of the contour planner that came after its configuration was laid down, a product of its own.
/// Older runs have none and were made with the defaults.
struct ContourOptions {
  ContourNormal normal = ContourNormal::Frontier;
  GainMeasure count = GainMeasure::Rays;
};
void fields(auto& a, Like<ContourOptions> auto& v) {
  a(v.normal, v.count);
}
/// What the hierarchical planner adds to the header, a product of its own.
void fields(auto& a, Like<OctreeHeader> auto& v) {
  a(v.planner, v.map, v.object_box);
}

// Arms, products of their own
/// As many numbers as there are joints.
void fields(auto& a, Like<JointVector> auto& v) {
  if constexpr (std::remove_cvref_t<decltype(a)>::kReading) {
    std::vector<double> values;
    a(values);
    if (values.size() > static_cast<std::size_t>(kMaxArmJoints)) throw DamagedBytes("too many joints");
    v = Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  } else {
    const std::vector<double> values(v.begin(), v.end());
    a(values);
  }
}
void fields(auto& a, Like<JointTrajectory> auto& v) {
  a(v.time_s, v.positions, v.velocities);
}
void fields(auto& a, Like<ArmJoint> auto& v) {
  a(v.name, v.prismatic, v.axis, v.T_parent_joint, v.lower, v.upper, v.max_velocity);
}
void fields(auto& a, Like<LinkShape> auto& v) {
  a(v.link, v.frame, v.kind, v.T_frame_shape, v.size_m, v.radius_m, v.length_m);
}
void fields(auto& a, Like<RobotModel> auto& v) {
  a(v.name, v.joints, v.shapes, v.T_tip_camera, v.camera_link);
}
void fields(auto& a, Like<ArmHeader> auto& v) {
  a(v.model, v.T_world_base, v.clear_boxes);
}

// One step
void fields(auto& a, Like<ScanPose> auto& v) {
  a(v.T_world_camera, v.frame);
}
void fields(auto& a, Like<DepthFrame> auto& v) {
  a(v.depth, v.T_world_camera, v.frame);
}
void fields(auto& a, Like<FilteredDepth> auto& v) {
  a(v.depth, v.mask);
}
void fields(auto& a, Like<MapMetrics> auto& v) {
  a(v.unknown_voxels, v.unknown_near_objects, v.unknown_in_boxes, v.coverage);
}
void fields(auto& a, Like<BoxMetrics> auto& v) {
  a(v.unknown, v.occupied);
}
void fields(auto& a, Like<Timings> auto& v) {
  a(v.sense, v.filter, v.fuse, v.contours, v.surface, v.segmentation, v.saliency, v.generation, v.evaluation,
    v.collision_map, v.motion_planning, v.motion);
}
/// What a record holds beside its products; Realised comes later and is stored apart.
void fields(auto& a, Like<StepRecord> auto& v) {
  a(v.step, v.closing, v.stage, v.planner, v.scan, v.metrics, v.toward_object, v.served, v.timings);
}
void fields(auto& a, Like<Realised> auto& v) {
  a(v.stage, v.voxels, v.served);
}
void fields(auto& a, Like<ContourVoxel> auto& v) {
  a(v.voxel, v.raw_normal, v.normal, v.group);
}
void fields(auto& a, Like<ContourPoint> auto& v) {
  a(v.position_m, v.normal, v.voxels);
}
void fields(auto& a, Like<Contours> auto& v) {
  a(v.voxels, v.points);
}
void fields(auto& a, Like<SurfaceCloud> auto& v) {
  a(v.points, v.normals, v.triangles);
}
void fields(auto& a, Like<Labels> auto& v) {
  a(v.of_point, v.count, v.supervoxels);
}
void fields(auto& a, Like<Segment> auto& v) {
  a(v.label, v.points, v.saliency, v.isolation, v.roundness, v.extent_m, v.axes, v.mean_m, v.center_m,
    v.radius_m);
}
void fields(auto& a, Like<Saliency> auto& v) {
  a(v.segments, v.distance_to_other_m);
}
void fields(auto& a, Like<ViewPosition> auto& v) {
  a(v.first_id, v.group, v.T_world_camera);
}

// The search
void fields(auto& a, Like<PoseScore> auto& v) {
  a(v.id, v.gain, v.unknown, v.occupied, v.reachability, v.executed_before, v.histogram);
}

/// Histograms one after the other: tens of thousands of short ones compress as one sequence.
template <class Archive>
void histograms(Archive& a, const std::vector<std::vector<std::uint32_t>>& all) {
  std::vector<std::uint32_t> bins, counts;
  for (const auto& histogram : all) {
    bins.push_back(static_cast<std::uint32_t>(histogram.size()));
    counts.insert(counts.end(), histogram.begin(), histogram.end());
  }
  a(bins, counts);
}
inline void histograms(ByteReader& a, std::vector<std::vector<std::uint32_t>>& all) {
  std::vector<std::uint32_t> bins, counts;
  a(bins, counts);
  all.clear();
  std::size_t at = 0;
  for (const std::uint32_t size : bins) {
    if (size > counts.size() - at) throw DamagedBytes("histograms shorter than they say");
    all.emplace_back(counts.begin() + at, counts.begin() + at + size);
    at += size;
  }
  if (at != counts.size()) throw DamagedBytes("histograms longer than they say");
}
void fields(auto& a, Like<SegmentSearch> auto& v) {
  a(v.segment, v.saliency, v.sphere, v.contour_points, v.poses_generated, v.scored, v.scores);
  histograms(a, v.histograms);
}
void fields(auto& a, Like<SearchCounts> auto& v) {
  a(v.poses_generated, v.poses_scored, v.poses_above_threshold, v.poses_unreachable, v.poses_executed_before,
    v.rays, v.voxels_visited, v.paths_planned);
}
void fields(auto& a, Like<MotionPlan> auto& v) {
  a(v.verdict, v.straight, v.waypoints, v.length_m, v.iterations);
}
void fields(auto& a, Like<ChosenView> auto& v) {
  a(v.id, v.T_world_camera, v.gain, v.gain_voxels, v.path);
}
void fields(auto& a, Like<ContourChosenView> auto& v) {
  a(v.id, v.contour_point, v.search, v.rank, v.T_world_camera, v.gain, v.gain_voxels, v.path);
}
void fields(auto& a, Like<ViewSearch> auto& v) {
  a(v.segments, v.chosen, v.counts, v.evaluation_s, v.motion_planning_s);
}
void fields(auto& a, Like<RayCounts> auto& v) {
  a(v.unknown, v.occupied, v.unknown_scene, v.rays, v.rays_cast, v.finest_rays_cast, v.visited,
    v.unknown_voxels, v.occupied_voxels, v.sensor_blocked);
}
void fields(auto& a, Like<ViewUtility> auto& v) {
  a(v.id, v.T_world_camera, v.frame, v.rejection, v.reachability, v.rays, v.unknown, v.occupied, v.surface,
    v.distance, v.utility);
}
void fields(auto& a, Like<UtilitySearch> auto& v) {
  a(v.views, v.ranking, v.chosen, v.counts, v.finest_rays_cast, v.rejected_position, v.rejected_registration,
    v.box_unknown, v.box_occupied, v.best_unknown, v.literal_stop, v.evaluation_s, v.motion_planning_s);
}

}  // namespace vantage
