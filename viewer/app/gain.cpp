#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "core/raycasting/uniform_caster.h"
#include "io/camera_file.h"
#include "io/table_file.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/inputs.h"
#include "viewer/app/json_output.h"

namespace vantage::app {
namespace {

struct GainOptions {
  std::string map, views, output, tracer = "uniform", outside = "opaque", count = "rays", camera;
  std::vector<double> bounds, sphere, fov_deg, range_m;
};

PinholeCamera chooseCamera(const GainOptions& options, const PinholeCamera& configured) {
  PinholeCamera camera = options.camera.empty() ? configured : readCamera(options.camera);
  if (!options.fov_deg.empty()) {
    constexpr double kDegree = std::numbers::pi / 180.0;
    const double h = options.fov_deg[0] * kDegree, v = options.fov_deg[1] * kDegree;
    if (!(h > 0 && h < std::numbers::pi && v > 0 && v < std::numbers::pi))
      throw InputError("--fov-deg", "apertures must lie between 0 and 180 degrees; give H,V");
    camera.fx = camera.width / 2.0 / std::tan(h / 2);
    camera.fy = camera.height / 2.0 / std::tan(v / 2);
    camera.cx = (camera.width - 1) / 2.0;
    camera.cy = (camera.height - 1) / 2.0;
  }
  if (!options.range_m.empty()) {
    camera.min_range_m = options.range_m[0];
    camera.max_range_m = options.range_m[1];
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

int gain(const GlobalOptions& global, const GainOptions& options) {
  requireDistinctFiles(
      {{"MAP", options.map}, {"VIEWS", options.views}, {"-o", options.output}, {"--json", global.json}});
  const LoadedMap map = loadMap(global, options.map);
  const std::vector<ViewRow> views = readViews(options.views);
  const PinholeCamera camera = chooseCamera(options, map.settings.camera);
  const VisibilityQuery query = makeQuery(options);
  const StateGrid states = makeStateGrid(map.volume);
  Console console(global);
  const RunControl control = console.control();
  std::vector<GainRow> rows(views.size());
  tbb::parallel_for(std::size_t{0}, views.size(), [&](std::size_t n) {
    if (control.stop.stop_requested()) return;
    const VisibilityCounts counts = castUniform(states, camera, views[n].T_world_camera, query);
    rows[n] = {views[n].id,
               query.distinct_voxels ? counts.unknown_voxels : counts.unknown,
               query.distinct_voxels ? counts.occupied_voxels : counts.occupied,
               counts.rays,
               counts.visited,
               ""};
  });
  if (console.interrupted()) throw Interrupted(options.output + ": interrupted; nothing was written");
  writeGains(options.output, rows);
  writeJson(
      global.json,
      {{"views", rows.size()}, {"rays_per_view", camera.width * camera.height}, {"count", options.count}});
  if (options.output != "-")
    say(global, fmt::format("{} views, {} rays each, counted as {}", rows.size(),
                            camera.width * camera.height, options.count));
  return 0;
}

}  // namespace

void addGain(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto o = std::make_shared<GainOptions>();
  CLI::App* command = app.add_subcommand("gain", "Unknown and occupied space that every view sees");
  command->add_option("map", o->map, "TSDF (.vti) or RUN#STEP")->required()->type_name("MAP");
  command->add_option("views", o->views, "View poses, CSV")->required()->type_name("VIEWS.csv");
  command->add_option("-o,--output", o->output, "Gains, CSV")->required()->type_name("GAINS.csv");
  command->add_option("--tracer", o->tracer, "How rays are cast")->check(CLI::IsMember({"uniform"}));
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
  command->add_option("--count", o->count, "What is counted")->check(CLI::IsMember({"rays", "voxels"}));
  command->add_option("--camera", o->camera, "Camera, OpenCV or ROS YAML (default: 512x424, f 365)")
      ->type_name("CAM.yaml");
  command->add_option("--fov-deg", o->fov_deg, "Full apertures instead of focal lengths, degrees")
      ->delimiter(',')
      ->expected(2)
      ->type_name("H,V");
  command->add_option("--range", o->range_m, "Ray lengths, metres (default: 0.5,8)")
      ->delimiter(',')
      ->expected(2)
      ->type_name("MIN,MAX");
  command->footer("Example: vantage gain map.vti views.csv -o gains.csv --sphere 0,0,0.1,0.3");
  command->callback([&global, &action, o] { action = [&global, o] { return gain(global, *o); }; });
}

}  // namespace vantage::app
