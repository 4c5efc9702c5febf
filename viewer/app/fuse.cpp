#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/perception/surface_cloud.h"
#include "io/cloud_file.h"
#include "io/dataset.h"
#include "io/octree_file.h"
#include "io/text_file.h"
#include "io/volume_file.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/counted.h"
#include "viewer/app/inputs.h"
#include "viewer/app/json_output.h"

namespace vantage::app {
namespace {

struct FuseOptions {
  std::string dataset, output, frames, mesh, cloud;
  std::optional<double> voxel_size_m, truncation_m;
  std::vector<double> bounds;
};

bool isOctree(const FuseOptions& options) {
  const auto ending = std::filesystem::path(options.output).extension();
  return ending == ".bt" || ending == ".ot";
}

/// Truncation in voxels where only the voxel size is given (spec of the contour planner, section 10).
constexpr double kTruncationVoxels = 5.12;

/// Half-open range of positions in the sequence from "A:B"; either side may be left out.
std::pair<std::size_t, std::size_t> frameRange(const std::string& text, std::size_t count) {
  if (text.empty()) return {0, count};
  const auto bad = [&] {
    return InputError(
        "--frames " + text,
        fmt::format("not a range of frames; give A:B, first and one past the last, 0 .. {}", count));
  };
  const auto number = [&](std::string_view part, std::size_t otherwise) {
    if (part.empty()) return otherwise;
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || end != part.data() + part.size()) throw bad();
    return value;
  };
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) throw bad();
  const std::size_t first = number(std::string_view(text).substr(0, colon), 0);
  const std::size_t last = number(std::string_view(text).substr(colon + 1), count);
  if (first >= last || last > count) throw bad();
  return {first, last};
}

void requireBounds(const std::vector<double>& b) {
  for (int a = 0; a < 3; ++a)
    if (!(b[a] < b[a + 3]))
      throw InputError("--bounds", "a lower limit is not below its upper one; give x0,y0,z0,x1,y1,z1");
}

/// Bounds rounded outward to whole voxels (the origin is the centre of the first).
GridGeometry boundedVolume(const std::vector<double>& b, double voxel_size_m) {
  requireBounds(b);
  GridGeometry geometry;
  geometry.voxel_size_m = voxel_size_m;
  for (int a = 0; a < 3; ++a) {
    const double first = std::floor(b[a] / voxel_size_m), last = std::ceil(b[a + 3] / voxel_size_m);
    if (last - first > 1 << 20)
      throw InputError("--bounds",
                       "more than a million voxels along one axis; choose smaller bounds or larger voxels");
    geometry.origin_m[a] = (first + 0.5) * voxel_size_m;
    geometry.size[a] = std::max(2, static_cast<int>(last - first));
  }
  return geometry;
}

/// The same box with another voxel size.
GridGeometry resampled(const GridGeometry& geometry, double voxel_size_m) {
  const Box box = geometry.bounds();
  return boundedVolume(
      {box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()},
      voxel_size_m);
}

void checkOptions(const GlobalOptions& global, const FuseOptions& options) {
  requireDistinctFiles({{"DATASET", options.dataset},
                        {"-o", options.output},
                        {"--mesh", options.mesh},
                        {"--cloud", options.cloud},
                        {"--json", global.json}});
  requireEnding("-o", options.output, {".vti", ".bt", ".ot"});
  if (!options.mesh.empty()) requireEnding("--mesh", options.mesh, {".ply"});
  if (!options.cloud.empty()) requireEnding("--cloud", options.cloud, {".pcd", ".ply"});
  if (options.voxel_size_m && !(*options.voxel_size_m >= 1e-4 && *options.voxel_size_m <= 1.0))
    throw InputError("--voxel-size",
                     fmt::format("{} m is out of range; allowed: 0.0001 .. 1", *options.voxel_size_m));
  if (!isOctree(options)) return;
  const auto refuse = [&](const char* option) {
    throw InputError(option, "belongs to a TSDF; write one (-o MAP.vti), or leave it out");
  };
  if (options.truncation_m) refuse("--truncation");
  if (!options.mesh.empty()) refuse("--mesh");
  if (!options.cloud.empty()) refuse("--cloud");
}

/// A frame, and the ball around its camera that is taken as empty: scan.clear_radius_m during the initial
/// scan, none later (D-B28).
using InsertFrame = std::function<void(const DepthImage&, const Pose&, double bubble_m)>;

/// Hands the frames asked for to `insert`. \return how many
std::size_t eachFrame(const GlobalOptions& global, const FuseOptions& options, const Dataset& dataset,
                      const ScanConfig& scan, const InsertFrame& insert) {
  const auto [first, last] = frameRange(options.frames, dataset.frames.size());
  Console console(global);
  const RunControl control = console.control();
  for (std::size_t n = first; n < last; ++n) {
    if (console.interrupted()) throw Interrupted(options.output + ": interrupted; nothing was written");
    control.report("fuse", n - first, last - first);
    const bool initial = n < static_cast<std::size_t>(scan.initial_frames);
    insert(loadDepth(dataset, n), dataset.frames[n].T_world_camera, initial ? scan.clear_radius_m : 0.0);
  }
  console.clear();
  return last - first;
}

void report(const GlobalOptions& global, std::size_t frames, const GridGeometry& geometry,
            std::uint64_t updated) {
  if (updated == 0)
    warn("no measurement reaches the mapped box; check --bounds, --frames and the camera's range");
  say(global, fmt::format("{} into {} x {} x {} voxels of {:.3f} mm, {} voxel updates",
                          counted(frames, "frame"), geometry.size.x(), geometry.size.y(), geometry.size.z(),
                          geometry.voxel_size_m * 1e3, updated));
  writeJson(global.json, {{"frames", frames},
                          {"size", {geometry.size.x(), geometry.size.y(), geometry.size.z()}},
                          {"voxel_size_m", geometry.voxel_size_m},
                          {"voxels_updated", updated}});
}

void fuseVolume(const GlobalOptions& global, const FuseOptions& options, const Dataset& dataset,
                const Settings& settings) {
  GridGeometry geometry = settings.exploration.volume;
  FusionConfig fusion = settings.exploration.fusion;
  if (options.voxel_size_m) geometry = resampled(geometry, *options.voxel_size_m);
  if (!options.bounds.empty()) geometry = boundedVolume(options.bounds, geometry.voxel_size_m);
  if (options.truncation_m)
    fusion.truncation_m = *options.truncation_m;
  else
    fusion.truncation_m = std::max(fusion.truncation_m, kTruncationVoxels * geometry.voxel_size_m);
  fusion.validate(geometry.voxel_size_m);

  TsdfVolume volume(geometry);
  std::uint64_t updated = 0;
  const std::size_t frames =
      eachFrame(global, options, dataset, settings.exploration.scan,
                [&](const DepthImage& depth, const Pose& pose, double bubble_m) {
                  if (bubble_m > 0.0) clearSphere(volume, pose.translation(), bubble_m);
                  updated += fuseDepth(volume, depth, settings.camera, pose, fusion).voxels_updated;
                });
  writeVolume(options.output, volume);
  if (!options.mesh.empty() || !options.cloud.empty()) {
    const SurfaceCloud surface =
        extractSurface(volume, settings.exploration.contour.contours.weight_threshold);
    if (!options.mesh.empty()) writeMesh(options.mesh, surface);
    if (!options.cloud.empty()) writeCloud(options.cloud, surface);
  }
  report(global, frames, geometry, updated);
}

/// The mapped space is that of a TSDF; what was not seen is unknown there. Bounds are the object's box too.
void fuseOctree(const GlobalOptions& global, const FuseOptions& options, const Dataset& dataset,
                const Settings& settings) {
  const ExplorationConfig& exploration = settings.exploration;
  const double voxel_size_m = options.voxel_size_m.value_or(exploration.octree.voxel_size_m);
  Box mapped = exploration.volume.bounds();
  if (!options.bounds.empty()) {
    requireBounds(options.bounds);
    mapped = Box(Eigen::Vector3d::Map(options.bounds.data()), Eigen::Vector3d::Map(&options.bounds[3]));
  }
  const GridGeometry grid = OccupancyOctree::gridAround(mapped, voxel_size_m);
  const Box object = options.bounds.empty() ? exploration.objectBox() : grid.bounds();
  OccupancyOctree map(grid, object, VoxelState::Unknown, exploration.octree.occupancy);
  std::uint64_t updated = 0;
  const std::size_t frames =
      eachFrame(global, options, dataset, exploration.scan,
                [&](const DepthImage& depth, const Pose& pose, double bubble_m) {
                  if (bubble_m > 0.0) map.clearSphere(pose.translation(), bubble_m);
                  const OccupancyUpdate scan = map.insert(depth, settings.camera, pose);
                  updated += scan.updated;
                  logDetail(fmt::format("fuse: {} hits, {} misses, {} voxels changed, {} nodes", scan.hits,
                                        scan.misses, scan.updated, map.nodeCount()));
                });
  writeOctree(options.output, map);
  report(global, frames, grid, updated);
}

int fuse(const GlobalOptions& global, const FuseOptions& options) {
  checkOptions(global, options);
  for (const std::string& file : {options.output, options.mesh, options.cloud})
    if (!file.empty()) requireCreatable(file);  // before the work, not after it
  Dataset dataset = openDataset(options.dataset);
  const Settings settings = datasetSettings(global, dataset);
  (isOctree(options) ? fuseOctree : fuseVolume)(global, options, dataset, settings);
  return 0;
}

}  // namespace

void addFuse(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto o = std::make_shared<FuseOptions>();
  CLI::App* command = app.add_subcommand("fuse", "Depth frames with poses into a TSDF or an octree");
  command->add_option("dataset", o->dataset, "Recorded RGB-D sequence: a folder, or a .bag of ROS 1")
      ->required()
      ->type_name("DATASET");
  command->add_option("-o,--output", o->output, "Map to write: TSDF (.vti) or octree (.bt, .ot)")
      ->required()
      ->type_name("MAP");
  command->add_option("--frames", o->frames, "Positions in the sequence, first and one past the last")
      ->type_name("A:B");
  command->add_option("--voxel-size", o->voxel_size_m, "Voxel edge, metres")->type_name("M");
  command
      ->add_option("--truncation", o->truncation_m,
                   "TSDF: truncation distance, metres (default: at least 5.12 voxels)")
      ->type_name("M");
  command
      ->add_option("--bounds", o->bounds,
                   "Mapped box, metres, rounded outward to whole voxels; of an octree the object's box too")
      ->delimiter(',')
      ->expected(6)
      ->type_name("x0,y0,z0,x1,y1,z1");
  command->add_option("--mesh", o->mesh, "TSDF: also the surface as a mesh")->type_name("FILE.ply");
  command->add_option("--cloud", o->cloud, "TSDF: also the surface points with normals")
      ->type_name("FILE.pcd");
  command->footer(
      "Example: vantage fuse recordings/tray -o tray.vti --voxel-size 0.004 --mesh tray.ply\n"
      "         vantage fuse recordings/tray -o tray.bt --voxel-size 0.01");
  command->callback([&global, &action, o] { action = [&global, o] { return fuse(global, *o); }; });
}

}  // namespace vantage::app
