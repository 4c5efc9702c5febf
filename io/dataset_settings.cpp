#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "io/config_fields.h"
#include "io/dataset.h"

namespace vantage {
namespace {

constexpr int kMostFrames = 60;      // looked at for the bounds, evenly chosen
constexpr int kPixelStep = 6;        // every 6th pixel of every 6th row
constexpr double kCell_m = 0.05;     // cells in which frames are counted
constexpr double kSeenShare = 0.25;  // a cell matters if this share of the frames saw it
constexpr double kTail = 0.02;       // of the points, left out at both ends of each axis
constexpr double kMargin_m = 0.05;   // of the volume around the workspace
constexpr double kReach_m = 0.15;    // of the volume around the recorded cameras
constexpr double kMostVoxels = 40e6;

using CellKey = std::tuple<int, int, int>;

struct Sample {
  Eigen::Vector3f p_world;
  CellKey cell;
};

/// In how many frames a cell was seen.
struct CellCount {
  int frames = 0;
  std::size_t last_frame = 0;
};

/// What was measured, thinned out.
struct Measured {
  std::vector<Sample> samples;
  std::vector<float> depth_m;
  std::map<CellKey, CellCount> cells;
  std::size_t frames = 0;
};

CellKey cellOf(const Eigen::Vector3d& p_world) {
  const Eigen::Array3d cell = (p_world / kCell_m).array().floor().max(-1e9).min(1e9);
  return {static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())};
}

void addFrame(const Dataset& dataset, std::size_t index, Measured& measured) {
  const DepthImage depth = loadDepth(dataset, index);
  const PinholeCamera& camera = dataset.camera;
  ++measured.frames;
  for (int v = 0; v < depth.height; v += kPixelStep) {
    for (int u = 0; u < depth.width; u += kPixelStep) {
      const float d = depth.at(u, v);
      if (!DepthImage::valid(d) || d < camera.min_range_m || d > camera.max_range_m) continue;
      const Eigen::Vector3d p_world = dataset.frames[index].T_world_camera * (double(d) * camera.ray(u, v));
      const CellKey cell = cellOf(p_world);
      CellCount& count = measured.cells[cell];
      if (count.last_frame != measured.frames) ++count.frames;
      count.last_frame = measured.frames;
      measured.samples.push_back({p_world.cast<float>(), cell});
      measured.depth_m.push_back(d);
    }
  }
}

Measured measure(const Dataset& dataset) {
  Measured measured;
  const std::size_t count = dataset.frames.size(), looked_at = std::min<std::size_t>(count, kMostFrames);
  for (std::size_t k = 0; k < looked_at; ++k) addFrame(dataset, k * count / looked_at, measured);
  return measured;
}

/// Coordinates of the points in cells that a share of the frames saw: what the sequence is about, without the
/// background that a few frames look past it. All points if too few are left.
std::array<std::vector<float>, 3> pointsOfInterest(const Measured& measured) {
  const auto collect = [&](double least_frames) {
    std::array<std::vector<float>, 3> axis;
    for (const Sample& sample : measured.samples) {
      if (measured.cells.at(sample.cell).frames < least_frames) continue;
      for (int a = 0; a < 3; ++a) axis[a].push_back(sample.p_world[a]);
    }
    return axis;
  };
  auto axis = collect(kSeenShare * static_cast<double>(measured.frames));
  return axis[0].size() * 20 < measured.samples.size() ? collect(0.0) : axis;
}

double quantile(std::vector<float>& values, double share) {
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(std::floor(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// To whole centimetres, away from the middle.
Box rounded(const Box& box) {
  const auto floor_cm = [](double x) { return std::floor(x * 100.0) / 100.0; };
  const auto ceil_cm = [](double x) { return std::ceil(x * 100.0) / 100.0; };
  return {box.min().unaryExpr(floor_cm), box.max().unaryExpr(ceil_cm)};
}

Box workspaceOf(const Dataset& dataset, const Measured& measured) {
  if (dataset.bounds) return *dataset.bounds;
  if (measured.depth_m.empty())
    throw InputError(
        dataset.path.string(),
        "no valid depth within the camera's range in any frame; check the depth unit, or state bounds");
  auto axis = pointsOfInterest(measured);
  Box box;
  for (int a = 0; a < 3; ++a) {
    box.min()[a] = quantile(axis[a], kTail) - 0.01;
    box.max()[a] = quantile(axis[a], 1.0 - kTail) + 0.01;
  }
  return rounded(box);
}

/// Where the device has been.
Box cameraBox(const Dataset& dataset) {
  Box box;
  for (const DatasetFrame& frame : dataset.frames) box.extend(frame.T_world_camera.translation());
  return box;
}

/// What has to be mapped: the workspace, and the cameras, since a view outside the map cannot be judged.
Box mappedBox(const Box& workspace, const Box& cameras) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kMargin_m),
                        reach = Eigen::Vector3d::Constant(kReach_m);
  return Box(workspace.min() - margin, workspace.max() + margin)
      .merged(Box(cameras.min() - reach, cameras.max() + reach));
}

/// Voxels of the default size, or larger ones if there would be too many.
GridGeometry volumeOf(const Box& box, double voxel_size_m) {
  const Eigen::Vector3d low = box.min();
  const Eigen::Vector3d extent = box.sizes();
  GridGeometry grid;
  grid.voxel_size_m = std::max(voxel_size_m, std::cbrt(extent.prod() / kMostVoxels));
  for (;; grid.voxel_size_m *= 1.02) {
    grid.size = (extent / grid.voxel_size_m).array().ceil().max(2.0).min(1e6).cast<int>();
    if (grid.size.cast<double>().prod() <= kMostVoxels && grid.size.maxCoeff() <= 8192) break;
  }
  grid.origin_m = low.array() + grid.voxel_size_m / 2;
  return grid;
}

/// The lengths that follow the voxel size, where it grows beyond the default.
void scaleWithVoxels(Settings& settings) {
  const double growth = settings.exploration.volume.voxel_size_m / ExplorationConfig{}.volume.voxel_size_m;
  if (growth <= 1.0) return;
  settings.exploration.fusion.truncation_m *= growth;
  settings.exploration.contour.contours.group_distance_m *= growth;
  settings.exploration.contour.segmentation.voxel_m *= growth;
  settings.exploration.contour.segmentation.seed_m *= growth;
}

void setScan(Settings& settings, const Dataset& dataset) {
  ScanConfig& scan = settings.exploration.scan;
  scan.initial_frames = static_cast<int>(std::min<std::size_t>(3, dataset.frames.size()));
  scan.frames = 1;
  scan.tilt_rad = 0.0;
  scan.clear_radius_m =
      0.0;  // no path starts here, and a bubble that was not seen would be something to look at
  scan.scene_center_m = (settings.exploration.workspace.center() * 1e3).array().round() / 1e3;
}

void setOrigins(Settings& settings) {
  const Settings defaults;
  for (const config::Field& field : config::fields())
    if (field.get(settings) != field.get(defaults)) settings.origins[field.key] = "data set";
}

}  // namespace

Settings settingsForDataset(const Dataset& dataset) {
  Measured measured = measure(dataset);
  Settings settings;
  settings.camera = dataset.camera;
  settings.dataset_position_m = dataset.T_world_dataset.translation();
  settings.dataset_orientation = orientationOf(dataset.T_world_dataset);
  ExplorationConfig& exploration = settings.exploration;
  exploration.workspace = workspaceOf(dataset, measured);
  const Box cameras = cameraBox(dataset);
  exploration.volume = volumeOf(mappedBox(exploration.workspace, cameras), exploration.volume.voxel_size_m);
  exploration.fusion.observations_per_frame = dataset.observations_per_frame;
  exploration.enforce_reachability = false;
  if (!measured.depth_m.empty())
    exploration.contour.views.distances_m = {
        std::max(0.05, std::round(quantile(measured.depth_m, 0.5) * 20.0) / 20.0)};
  exploration.octree.outside = VoxelState::Unknown;  // D-A10
  exploration.recorded_candidates = true;
  scaleWithVoxels(settings);
  setScan(settings, dataset);
  settings.free_flyer.reach_m = 0.0;
  settings.free_flyer.min_height_m = cameras.min().z() - kReach_m;
  setOrigins(settings);
  return settings;
}

}  // namespace vantage
