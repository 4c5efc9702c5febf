#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "core/raycasting/hierarchical_caster.h"
#include "core/raycasting/uniform_caster.h"
#include "io/camera_file.h"
#include "io/table_file.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/counted.h"
#include "viewer/app/inputs.h"
#include "viewer/app/json_output.h"

namespace vantage::app {
namespace {

struct GainOptions {
  std::string map, views, output, tracer = "uniform", outside = "opaque", count = "rays", camera;
  std::vector<double> bounds, sphere, fov_deg, range_m;
  std::optional<int> coarse_levels;
  bool restart = false;
  bool hierarchical() const { return tracer == "hierarchical"; }
  bool voxels() const { return count == "voxels"; }
};

/// Full apertures in radians. \pre given
std::array<double, 2> fovOf(const GainOptions& options) {
  constexpr double kDegree = std::numbers::pi / 180.0, kLeast = 0.1, kMost = 179.0;
  for (const double degrees : options.fov_deg)
    if (!(degrees >= kLeast && degrees <= kMost))
      throw InputError(
          fmt::format("--fov-deg {:g},{:g}", options.fov_deg[0], options.fov_deg[1]),
          fmt::format("an aperture is out of range; give H,V, each {:g} .. {:g} degrees", kLeast, kMost));
  return {options.fov_deg[0] * kDegree, options.fov_deg[1] * kDegree};
}

/// Shortest and longest ray. \pre given
std::array<double, 2> rangeOf(const GainOptions& options) {
  const double near = options.range_m[0], far = options.range_m[1];
  if (!(near >= 0.0 && far <= 1000.0 && far >= 1e-3 && far > near + 1e-6))
    throw InputError(fmt::format("--range {:g},{:g}", near, far),
                     "no range of ray lengths; give MIN,MAX in metres, 0 <= MIN < MAX <= 1000");
  return {near, far};
}

PinholeCamera chooseCamera(const GainOptions& options, const PinholeCamera& configured) {
  PinholeCamera camera = options.camera.empty() ? configured : readCamera(options.camera);
  if (!options.fov_deg.empty()) {
    const auto [h, v] = fovOf(options);
    camera.fx = camera.width / 2.0 / std::tan(h / 2);
    camera.fy = camera.height / 2.0 / std::tan(v / 2);
    camera.cx = (camera.width - 1) / 2.0;
    camera.cy = (camera.height - 1) / 2.0;
  }
  if (!options.range_m.empty()) {
    const auto [near, far] = rangeOf(options);
    camera.min_range_m = near;
    camera.max_range_m = far;
  }
  camera.validate();
  return camera;
}

VisibilityQuery makeQuery(const GainOptions& options) {
  VisibilityQuery query;
  for (const auto* numbers : {&options.sphere, &options.bounds})
    for (const double x : *numbers)
      if (!std::isfinite(x))
        throw InputError(numbers == &options.sphere ? "--sphere" : "--bounds",
                         "holds something that is no finite number");
  if (!options.sphere.empty()) {
    if (!(options.sphere[3] >= 0))
      throw InputError("--sphere", "the radius is negative; give x,y,z,r in metres");
    query.sphere = Sphere{{options.sphere[0], options.sphere[1], options.sphere[2]}, options.sphere[3]};
  }
  if (!options.bounds.empty()) {
    const auto& b = options.bounds;
    query.bounds = Box(Eigen::Vector3d(b[0], b[1], b[2]), Eigen::Vector3d(b[3], b[4], b[5]));
    if (query.bounds->isEmpty())
      throw InputError("--bounds", "a lower limit is above its upper one; give x0,y0,z0,x1,y1,z1");
  }
  query.outside = options.outside == "opaque" ? OutsideUnknown::Opaque : OutsideUnknown::Transparent;
  query.distinct_voxels = options.count == "voxels";
  return query;
}

/// Gains of all views, and what was cast.
struct Gains {
  std::vector<GainRow> rows;
  std::uint64_t rays_per_view = 0;
};

/// Calls `cast` for every view, in parallel.
void eachView(const GlobalOptions& global, const GainOptions& options, const std::vector<ViewRow>& views,
              std::vector<GainRow>& rows, const std::function<GainRow(const ViewRow&)>& cast) {
  Console console(global);
  const RunControl control = console.control();
  rows.resize(views.size());
  tbb::parallel_for(std::size_t{0}, views.size(), [&](std::size_t n) {
    if (!control.stop.stop_requested()) rows[n] = cast(views[n]);
  });
  if (console.interrupted()) throw Interrupted(options.output + ": interrupted; nothing was written");
}

/// The sensor is in the map, but not in free space; around a TSDF there is nothing.
bool standsInSomething(const StateGrid& states, const Pose& pose) {
  const Eigen::Vector3i voxel = states.geometry().voxelAt(pose.translation());
  return states.geometry().contains(voxel) && states.at(voxel) != VoxelState::Free;
}

/// One ray a pixel through a TSDF. What a sensor sees that stands in something is told, and that it does.
Gains cameraGains(const GlobalOptions& global, const GainOptions& options, const LoadedMap& map,
                  const std::vector<ViewRow>& views) {
  const PinholeCamera camera = chooseCamera(options, map.settings.camera);
  const VisibilityQuery query = makeQuery(options);
  const StateGrid states = makeStateGrid(map.volume);
  Gains gains;
  gains.rays_per_view = static_cast<std::uint64_t>(camera.width) * camera.height;
  eachView(global, options, views, gains.rows, [&](const ViewRow& view) -> GainRow {
    const VisibilityCounts c = castUniform(states, camera, view.T_world_camera, query);
    return {view.id,
            options.voxels() ? c.unknown_voxels : c.unknown,
            options.voxels() ? c.occupied_voxels : c.occupied,
            c.rays,
            c.visited,
            standsInSomething(states, view.T_world_camera) ? "position" : ""};
  });
  return gains;
}

/// Sensor of eq. 6 of the hierarchical planner.
RaySensor chooseSensor(const GainOptions& options, RaySensor sensor) {
  if (!options.fov_deg.empty()) {
    const auto [h, v] = fovOf(options);
    sensor.horizontal_fov_rad = h;
    sensor.vertical_fov_rad = v;
  }
  if (!options.range_m.empty()) {
    const auto [near, far] = rangeOf(options);
    sensor.min_range_m = near;
    sensor.max_range_m = far;
  }
  sensor.validate();
  return sensor;
}

/// Levels above the finest at which tracing starts. \throws InputError with the largest number allowed
int chooseLevels(const GainOptions& options, int configured, const RaySensor& sensor, double voxel_size_m) {
  const int most = maxCoarseLevels(sensor, voxel_size_m);
  if (most < 0)
    throw InputError(options.map, fmt::format("its voxels of {} m are too large for this sensor, which sees "
                                              "less than one at its range; raise --range or --fov-deg",
                                              voxel_size_m));
  if (!options.hierarchical()) return 0;
  const int levels = options.coarse_levels.value_or(configured);
  if (levels >= 0 && levels <= most) return levels;
  const std::string name = options.coarse_levels ? "--coarse-levels" : "rays.coarse_levels =";
  throw InputError(fmt::format("{} {}", name, levels),
                   fmt::format("too many levels for voxels of {} m and this sensor; allowed: 0 .. {}{}",
                               voxel_size_m, most, options.coarse_levels ? "" : " (--coarse-levels)"));
}

void requireRayOptions(const GainOptions& options) {
  const std::string what = "does not go with the rays of an octree or of the hierarchical tracer; ";
  if (!options.camera.empty())
    throw InputError("--camera", what + "give full apertures with --fov-deg H,V and --range MIN,MAX");
  if (options.outside == "transparent")
    throw InputError("--outside", what + "there every voxel that is not free ends a ray");
}

HierarchicalQuery makeRayQuery(const GainOptions& options, const HierarchicalPlannerConfig& planner) {
  const VisibilityQuery region = makeQuery(options);
  HierarchicalQuery query;
  query.bounds = region.bounds;
  query.sphere = region.sphere;
  query.start = options.restart ? ChildStart::Restart : planner.child_start;
  query.refine_unknown = planner.refine_unknown || options.voxels();
  query.distinct_voxels = options.voxels();
  return query;
}

StatePyramid makePyramid(const LoadedMap& map, bool octree, int levels) {
  if (octree) return {*map.octree, levels};
  return {makeStateGrid(map.volume), Eigen::Vector3i::Zero(), levels};
}

/// The rays of eq. 6 through the finest voxels or hierarchically. A sensor that does not stand in free space
/// has no view; around an octree everything is unknown.
Gains rayGains(const GlobalOptions& global, const GainOptions& options, const LoadedMap& map, bool octree,
               const std::vector<ViewRow>& views) {
  requireRayOptions(options);
  const HierarchicalPlannerConfig& planner = map.settings.exploration.hierarchical;
  const RaySensor sensor = chooseSensor(options, planner.sensor);
  const GridGeometry& grid = octree ? map.octree->geometry() : map.volume.geometry();
  const int levels = chooseLevels(options, planner.coarse_levels, sensor, grid.voxel_size_m);
  const RayTree tree(sensor, grid.voxel_size_m, levels);
  const HierarchicalQuery query = makeRayQuery(options, planner);
  const StatePyramid pyramid = makePyramid(map, octree, levels);
  Gains gains;
  gains.rays_per_view = tree.level(0).count();
  eachView(global, options, views, gains.rows, [&](const ViewRow& view) -> GainRow {
    const Pose& pose = view.T_world_camera;
    if (octree && !grid.contains(grid.voxelAt(pose.translation()))) return {view.id, 0, 0, 0, 0, "position"};
    const RayCounts c = options.hierarchical() ? castHierarchical(pyramid, tree, levels, pose, query)
                                               : castUniformRays(pyramid.finest(), tree, pose, query);
    return {view.id,
            options.voxels() ? c.unknown_voxels : c.unknown,
            options.voxels() ? c.occupied_voxels : c.occupied,
            c.rays,
            c.visited,
            c.sensor_blocked ? "position" : ""};
  });
  return gains;
}

/// A region that holds nothing of the map is hardly meant.
void warnOfEmptyRegion(const GainOptions& options, const Box& mapped) {
  const VisibilityQuery region = makeQuery(options);
  if (region.bounds && !overlap(*region.bounds, mapped))
    warn("--bounds: the box lies outside the map; no voxel counts");
  if (region.sphere && mapped.exteriorDistance(region.sphere->center) > region.sphere->radius)
    warn("--sphere: the ball lies outside the map; no voxel counts");
}

/// Of a run that keeps both maps, the one that the step's planner worked on.
bool isOctree(const LoadedMap& map) {
  if (!map.octree || !map.hasVolume()) return map.octree.has_value();
  return map.record && map.record->utilities;
}

void report(const GlobalOptions& global, const GainOptions& options, const Gains& gains, double seconds) {
  std::uint64_t rays = 0, visited = 0, rejected = 0, best = 0;
  for (const GainRow& row : gains.rows) {
    rays += row.rays;
    visited += row.visited;
    rejected += !row.reject.empty();
    best = std::max(best, row.unknown);
  }
  logDetail(fmt::format("gain: {}, {} rejected, {} rays, {} voxels visited, {:.3f} s",
                        counted(gains.rows.size(), "view"), rejected, rays, visited, seconds));
  writeJson(global.json, {{"views", gains.rows.size()},
                          {"rays_per_view", gains.rays_per_view},
                          {"count", options.count},
                          {"tracer", options.tracer},
                          {"rejected", rejected},
                          {"rays", rays},
                          {"visited", visited},
                          {"most_unknown", best},
                          {"seconds", seconds}});
  if (options.output != "-")
    say(global, fmt::format("{}, {} rays each, counted as {}", counted(gains.rows.size(), "view"),
                            gains.rays_per_view, options.count));
}

int gain(const GlobalOptions& global, const GainOptions& options) {
  requireDistinctFiles(
      {{"MAP", options.map}, {"VIEWS", options.views}, {"-o", options.output}, {"--json", global.json}});
  for (const auto& [given, name] : {std::pair(options.coarse_levels.has_value(), "--coarse-levels"),
                                    std::pair(options.restart, "--restart")})
    if (given && !options.hierarchical())
      throw InputError(name,
                       "belongs to the hierarchical tracer; add --tracer hierarchical, or leave it out");
  const LoadedMap map = loadMap(global, options.map, MapNeed::Either);
  const std::vector<ViewRow> views = readViews(options.views);
  const bool octree = isOctree(map);
  warnOfEmptyRegion(options, octree ? map.octree->geometry().bounds() : map.volume.geometry().bounds());
  const auto start = std::chrono::steady_clock::now();
  const Gains gains = octree || options.hierarchical() ? rayGains(global, options, map, octree, views)
                                                       : cameraGains(global, options, map, views);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  writeGains(options.output, gains.rows);
  report(global, options, gains, seconds);
  return 0;
}

}  // namespace

void addGain(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto o = std::make_shared<GainOptions>();
  CLI::App* command = app.add_subcommand("gain", "Unknown and occupied space that every view sees");
  command->add_option("map", o->map, "TSDF (.vti), octree (.bt, .ot) or RUN#STEP")
      ->required()
      ->type_name("MAP");
  command->add_option("views", o->views, "View poses, CSV")->required()->type_name("VIEWS.csv");
  command->add_option("-o,--output", o->output, "Gains, CSV")->required()->type_name("GAINS.csv");
  command->add_option("--tracer", o->tracer, "All rays at the finest voxels, or coarse ones first")
      ->check(CLI::IsMember({"uniform", "hierarchical"}));
  command
      ->add_option("--coarse-levels", o->coarse_levels,
                   "Hierarchical: levels above the finest at which rays start (default: 2)")
      ->type_name("M");
  command->add_flag("--restart", o->restart, "Hierarchical: refined rays start at the sensor again");
  command->add_option("--bounds", o->bounds, "Only voxels in this box count, metres")
      ->delimiter(',')
      ->expected(6)
      ->type_name("x0,y0,z0,x1,y1,z1");
  command->add_option("--sphere", o->sphere, "Only voxels in this ball count, metres")
      ->delimiter(',')
      ->expected(4)
      ->type_name("x,y,z,r");
  command->add_option("--outside", o->outside, "Unknown space outside ball and box")
      ->check(CLI::IsMember({"opaque", "transparent"}));
  command
      ->add_option("--count", o->count,
                   "What is counted; for voxels the hierarchical tracer refines unknown nodes too")
      ->check(CLI::IsMember({"rays", "voxels"}));
  command->add_option("--camera", o->camera, "TSDF: camera, OpenCV or ROS YAML (default: 512x424, f 365)")
      ->type_name("CAM.yaml");
  command->add_option("--fov-deg", o->fov_deg, "Full apertures, degrees (default with an octree: 57,43)")
      ->delimiter(',')
      ->expected(2)
      ->type_name("H,V");
  command->add_option("--range", o->range_m, "Ray lengths, metres (default: 0.5,8; with an octree 0.4,2.8)")
      ->delimiter(',')
      ->expected(2)
      ->type_name("MIN,MAX");
  command->footer(
      "Example: vantage gain map.vti views.csv -o gains.csv --sphere 0,0,0.1,0.3\n"
      "         vantage gain map.bt views.csv -o gains.csv --tracer hierarchical --coarse-levels 2");
  command->callback([&global, &action, o] { action = [&global, o] { return gain(global, *o); }; });
}

}  // namespace vantage::app
