#include "viewer/map_session.h"

#include <algorithm>
#include <cmath>

#include "core/exploration/planner_kind.h"
#include "io/cloud_file.h"
#include "io/config_file.h"
#include "io/mesh_file.h"
#include "io/octree_file.h"
#include "io/scene_file.h"
#include "io/volume_file.h"
#include "viewer/file_kind.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// The step of a file while it is put together.
struct Draft {
  RunHeader header;
  StepRecord record;
  StepData finish(StepData data) {
    record.stage = Stage::Done;
    data.header = std::make_shared<const RunHeader>(std::move(header));
    data.record = std::make_shared<const StepRecord>(std::move(record));
    return data;
  }
};

Draft draftOf(const fs::path& file, PlannerKind planner) {
  Draft draft;
  draft.header.input = file.string();
  draft.header.planner = draft.record.planner = toString(planner);
  return draft;
}

/// Space of things without a map: nothing is known there, in few voxels.
StepData unmapped(Draft draft, Box box) {
  constexpr double kEdge = 32.0;  // voxels along the longest side
  if (box.isEmpty()) box = Box(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());
  const double longest_m = std::max(1e-3, box.sizes().maxCoeff());
  GridGeometry& grid = draft.header.volume;
  grid.voxel_size_m = longest_m / kEdge;
  grid.origin_m = box.min().array() + grid.voxel_size_m / 2;
  grid.size = (box.sizes() / grid.voxel_size_m).array().ceil().cast<int>().max(2);
  draft.header.workspace = grid.bounds();
  StepData data;
  data.states = std::make_shared<const StateGrid>(grid);
  draft.record.metrics.unknown_voxels = grid.count();
  return draft.finish(std::move(data));
}

/// A little more than the box, so that nothing lies in its faces.
Box padded(const Box& box) {
  if (box.isEmpty()) return box;
  const double margin_m = std::max(0.01, 0.05 * box.sizes().maxCoeff());
  return {box.min().array() - margin_m, box.max().array() + margin_m};
}

Box boundsOf(const std::vector<Eigen::Vector3f>& points) {
  Box box;
  for (const Eigen::Vector3f& p : points)
    if (p.allFinite()) box.extend(p.cast<double>());
  return padded(box);
}

StepData openTsdf(const fs::path& file, std::vector<std::string>* warnings) {
  std::vector<std::string> ignored;
  auto volume = std::make_shared<const TsdfVolume>(readVolume(file, warnings ? *warnings : ignored));
  auto states = std::make_shared<const StateGrid>(makeStateGrid(*volume));
  Draft draft = draftOf(file, PlannerKind::Contour);
  draft.header.volume = volume->geometry();
  draft.header.workspace = volume->geometry().bounds();
  draft.record.metrics.unknown_voxels = states->count(VoxelState::Unknown, draft.header.workspace);
  draft.record.surface =
      std::make_shared<const SurfaceCloud>(extractSurface(*volume, ContourConfig{}.weight_threshold));
  StepData data;
  data.states = states;
  data.volume = volume;
  return draft.finish(std::move(data));
}

/// A planner's sensor at the map's resolution, with as many coarse levels as it allows.
OctreeHeader octreeHeaderOf(const OccupancyOctree& map) {
  OctreeHeader header;
  header.object_box = header.map.object_box = map.objectBox();
  header.map.voxel_size_m = map.geometry().voxel_size_m;
  header.map.occupancy = map.config();
  const int most = maxCoarseLevels(header.planner.sensor, header.map.voxel_size_m);
  header.planner.coarse_levels = std::clamp(header.planner.coarse_levels, 0, std::max(0, most));
  return header;
}

StepData openOctree(const fs::path& file) {
  auto map = std::make_shared<const OccupancyOctree>(readOctree(file, {}));
  auto pyramid = std::make_shared<const StatePyramid>(*map, StatePyramid::kMaxCoarseLevels);
  Draft draft = draftOf(file, PlannerKind::Hierarchical);
  draft.header.octree = octreeHeaderOf(*map);
  draft.header.volume = map->geometry();
  draft.header.workspace = map->geometry().bounds();
  const Box& object = draft.header.octree->object_box;
  const StateGrid& states = pyramid->finest();
  draft.record.metrics.unknown_voxels = states.count(VoxelState::Unknown, draft.header.workspace);
  draft.record.box = std::make_shared<const BoxMetrics>(
      BoxMetrics{states.count(VoxelState::Unknown, object), states.count(VoxelState::Occupied, object)});
  StepData data;
  data.states = {pyramid, &states};
  data.octree = map;
  data.pyramid = pyramid;
  const OctreeHeader& octree = *draft.header.octree;
  if (maxCoarseLevels(octree.planner.sensor, octree.map.voxel_size_m) >=
      0)  // else no sensor tells voxels apart
    data.tree = std::make_shared<const RayTree>(octree.planner.sensor, octree.map.voxel_size_m,
                                                octree.planner.coarse_levels);
  return draft.finish(std::move(data));
}

StepData openScene(const fs::path& file) {
  const SceneFile scene = loadScene(file.string());
  Settings settings;
  applyScene(settings, scene);
  settings.validate();
  Draft draft = draftOf(scene.name, PlannerKind::Contour);
  draft.header.scene_toml = scene.text;
  draft.header.camera = settings.camera;
  draft.header.truth = sceneMesh(scene, false);
  if (draft.header.truth.empty()) draft.header.truth = sceneMesh(scene, true);
  return unmapped(std::move(draft), settings.exploration.workspace);
}

StepData openMesh(const fs::path& file) {
  Draft draft = draftOf(file, PlannerKind::Contour);
  draft.header.truth = loadMesh(file.string());
  const Box box = boundsOf(draft.header.truth.vertices);
  return unmapped(std::move(draft), box);
}

StepData openCloud(const fs::path& file) {
  Draft draft = draftOf(file, PlannerKind::Contour);
  draft.record.surface = std::make_shared<const SurfaceCloud>(readCloud(file.string()));
  const Box box = boundsOf(draft.record.surface->points);
  return unmapped(std::move(draft), box);
}

StepData openViews(const fs::path& file) {
  const std::vector<ViewRow> views = readViews(file.string());
  constexpr double kAhead_m = 0.5;
  Box box;
  for (const ViewRow& view : views) {
    box.extend(view.T_world_camera.translation());
    box.extend(view.T_world_camera * Eigen::Vector3d(0.0, 0.0, kAhead_m));
  }
  return withViews(unmapped(draftOf(file, PlannerKind::Contour), padded(box)), views);
}

}  // namespace

StepData openAsStep(const fs::path& file, std::vector<std::string>* warnings) {
  const FileKind kind = requireKind(file);
  switch (kind) {
    case FileKind::Tsdf:
      return openTsdf(file, warnings);
    case FileKind::Octree:
      return openOctree(file);
    case FileKind::Scene:
      return openScene(file);
    case FileKind::Mesh:
      return openMesh(file);
    case FileKind::Cloud:
      return openCloud(file);
    case FileKind::Views:
      return openViews(file);
    case FileKind::Dataset:
      throw InputError(file.string(), "is a recording; explore it first: vantage explore " + file.string() +
                                          " -o RUN.vantage");
    default:
      throw InputError(file.string(),
                       "is a " + std::string(nameOf(kind)) + ", which has no step of its own to show");
  }
}

StepData withViews(StepData step, const std::vector<ViewRow>& views) {
  StepRecord record = *step.record;
  const std::uint32_t rolls = rollsOf(*step.header);
  auto positions = std::make_shared<std::vector<ViewPosition>>();
  for (const ViewRow& view : views)
    positions->push_back({static_cast<std::uint32_t>(positions->size()) * rolls, 0, view.T_world_camera});
  record.positions = std::move(positions);
  record.search.reset();
  record.utilities.reset();
  record.point_labels.reset();
  step.record = std::make_shared<const StepRecord>(std::move(record));
  return step;
}

}  // namespace vantage
