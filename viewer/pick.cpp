#include "viewer/pick.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "viewer/contour_marks.h"
#include "viewer/face_rows.h"

namespace vantage {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// The part of a ray within a box.
struct Span {
  double enter = 0.0, leave = kFar;
  bool empty() const { return !(enter < leave); }
};

Span spanIn(const Box& box, const EyeRay& ray) {
  Span span;
  if (box.isEmpty()) return {0.0, 0.0};
  for (int a = 0; a < 3; ++a) {
    const double to_low = box.min()[a] - ray.origin[a], to_high = box.max()[a] - ray.origin[a];
    if (std::abs(ray.direction[a]) < 1e-15) {
      if (to_low > 0.0 || to_high < 0.0) return {0.0, 0.0};
      continue;
    }
    const double at_low = to_low / ray.direction[a], at_high = to_high / ray.direction[a];
    span.enter = std::max(span.enter, std::min(at_low, at_high));
    span.leave = std::min(span.leave, std::max(at_low, at_high));
  }
  return span;
}

/// Calls visit(voxel, distance at its entry) for the voxels of a grid along a span of a ray, until it says
/// true.
template <class Visit>
void walkVoxels(const GridGeometry& grid, const EyeRay& ray, const Span& span, Visit&& visit) {
  const Eigen::Vector3i last = grid.size - Eigen::Vector3i::Ones();
  Eigen::Vector3i voxel =
      grid.voxelAt(ray.origin + span.enter * ray.direction).cwiseMax(Eigen::Vector3i::Zero()).cwiseMin(last);
  Eigen::Vector3i step;
  Eigen::Vector3d next, every;
  for (int a = 0; a < 3; ++a) {
    const double d = ray.direction[a];
    step[a] = d > 0.0 ? 1 : d < 0.0 ? -1 : 0;
    every[a] = step[a] ? grid.voxel_size_m / std::abs(d) : kFar;
    const double border = grid.center(voxel)[a] + step[a] * grid.voxel_size_m / 2;
    next[a] = step[a] ? (border - ray.origin[a]) / d : kFar;
  }
  double at = span.enter;
  while (at < span.leave && grid.contains(voxel)) {
    if (visit(voxel, at)) return;
    int axis = 0;
    next.minCoeff(&axis);
    at = next[axis];
    next[axis] += every[axis];
    voxel[axis] += step[axis];
  }
}

bool within(const VoxelRange& range, const Eigen::Vector3i& voxel) {
  return (voxel.array() >= range.begin.array()).all() && (voxel.array() < range.end.array()).all();
}

Box cut(Box box, const std::optional<Box>& clip) {
  return clip ? box.intersection(*clip) : box;
}

/// The first voxel whose faces are drawn.
std::optional<VoxelPick> pickSolid(const SceneFrame& frame, const ViewSettings& settings, const EyeRay& ray) {
  const LayerSet& shown = settings.layers;
  const bool occupied = shown.has(Layer::Occupied) || shown.has(Layer::Octree) || shown.has(Layer::Surface) ||
                        shown.has(Layer::Segments);
  const bool frontier = shown.has(Layer::Unknown) || shown.has(Layer::Octree);
  const GridGeometry& grid = frame.states.geometry();
  if (grid.count() == 0 || (!occupied && !frontier)) return std::nullopt;
  const VoxelRange occupied_in = voxelsIn(grid, occupiedBox(frame)),
                   unknown_in = voxelsIn(grid, frame.header.workspace);
  const Span span = spanIn(cut(grid.bounds(), settings.clip), ray);
  std::optional<VoxelPick> found;
  bool came_from_free = false;
  walkVoxels(grid, ray, span, [&](const Eigen::Vector3i& voxel, double at) {
    const VoxelState state = frame.states.at(voxel);
    const bool stops =
        (occupied && state == VoxelState::Occupied && within(occupied_in, voxel)) ||
        (frontier && state == VoxelState::Unknown && came_from_free && within(unknown_in, voxel));
    came_from_free = state == VoxelState::Free && within(unknown_in, voxel);
    if (stops) found = VoxelPick{voxel, state, at};
    return stops;
  });
  return found;
}

std::optional<VoxelPick> pickSlice(const SceneFrame& frame, const ViewSettings& settings, const EyeRay& ray) {
  const GridGeometry& grid = frame.states.geometry();
  if (grid.count() == 0 || !settings.layers.has(Layer::Slices)) return std::nullopt;
  const Box bounds = slicedBox(frame);
  std::optional<VoxelPick> nearest;
  for (int axis = 0; axis < 3; ++axis) {
    const SlicePlane& slice = settings.style.slices[axis];
    if (!slice.shown || bounds.isEmpty() || ray.direction[axis] == 0.0) continue;
    const double plane_m = slice.at_m.value_or(bounds.center()[axis]);
    const double at = (plane_m - ray.origin[axis]) / ray.direction[axis];
    Eigen::Vector3d p = ray.origin + at * ray.direction;
    p[axis] = plane_m;
    const bool inside = bounds.contains(p) && (!settings.clip || settings.clip->contains(p));
    if (at <= 0.0 || !inside || (nearest && nearest->distance_m <= at)) continue;
    const Eigen::Vector3i voxel = grid.voxelAt(p).cwiseMax(0).cwiseMin(grid.size - Eigen::Vector3i::Ones());
    nearest = VoxelPick{voxel, frame.states.at(voxel), at};
  }
  return nearest;
}

/// A thing that is found by where it appears.
struct Mark {
  PickedKind kind;
  std::uint32_t id;
  Eigen::Vector3d p_world;
};

void addViews(const SceneFrame& frame, const ViewSettings& settings, std::vector<Mark>& marks) {
  const StepRecord& record = frame.record;
  const auto add = [&](std::uint32_t id, const Pose& pose) {
    marks.push_back({PickedKind::Frustum, id, pose.translation()});
  };
  if (settings.layers.has(Layer::ChosenView) && record.hasView())
    add(record.chosen()->id, record.chosen()->T_world_camera);
  if (settings.layers.has(Layer::RankedViews)) {
    for (const RankedPosition& view : drawnViews(frame, settings.style)) add(view.id, view.T_world_camera);
  }
  const bool all = settings.layers.has(Layer::Candidates) || settings.layers.has(Layer::UtilitySphere);
  if (all && record.utilities) {
    for (const ViewUtility& view : record.utilities->views) add(view.id, view.T_world_camera);
  } else if (settings.layers.has(Layer::Candidates) && record.positions) {
    for (const ViewPosition& position : *record.positions) add(position.first_id, position.T_world_camera);
  }
}

void addContourPoints(const SceneFrame& frame, const ViewSettings& settings, std::vector<Mark>& marks) {
  if (!settings.layers.has(Layer::ContourPoints) || !frame.record.contours) return;
  for (std::uint32_t n = 0; n < frame.record.contours->points.size(); ++n) {
    const ContourPoint& point = frame.record.contours->points[n];
    if (settings.clip && !settings.clip->contains(point.position_m)) continue;
    marks.push_back({PickedKind::ContourPoint, n, point.position_m});
    marks.push_back({PickedKind::ContourPoint, n, normalTip(point)});
  }
}

/// The mark nearest to a point of the picture, of equally near ones the first. What lies farther from the eye
/// than `solid_m` is hidden.
std::optional<Picked> nearestMark(const std::vector<Mark>& marks, const Eye& eye,
                                  const Eigen::Vector2d& at_px, const PictureSize& picture, double solid_m,
                                  double tolerance_m) {
  std::optional<Picked> nearest;
  double best = 1.0;  // share of its radius
  for (const Mark& mark : marks) {
    const auto pixel = pixelOf(eye, mark.p_world, picture);
    if (!pixel) continue;
    const double radius =
        mark.kind == PickedKind::Frustum ? Picker::kFrustumRadius_px : Picker::kContourRadius_px;
    const double share = (*pixel - at_px).norm() / radius;
    const double distance_m = (mark.p_world - eye.position).norm();
    if (share >= best || distance_m > solid_m + tolerance_m) continue;
    best = share;
    nearest = Picked{mark.kind, mark.p_world, distance_m, mark.id};
  }
  return nearest;
}

}  // namespace

std::optional<VoxelPick> pickVoxel(const SceneFrame& frame, const ViewSettings& settings, const EyeRay& ray) {
  const auto solid = pickSolid(frame, settings, ray), slice = pickSlice(frame, settings, ray);
  if (!solid || !slice) return solid ? solid : slice;
  return slice->distance_m < solid->distance_m ? slice : solid;
}

std::optional<Picked> Picker::at(const SceneFrame& frame, const ViewSettings& settings, const Eye& eye,
                                 const Eigen::Vector2d& at_px, const PictureSize& picture) {
  const EyeRay ray = eyeRay(eye, at_px, picture);
  const std::optional<VoxelPick> solid = pickVoxel(frame, settings, ray);
  std::vector<Mark> marks;
  addViews(frame, settings, marks);
  addContourPoints(frame, settings, marks);
  // Contour points lie beside the voxels that stop the ray.
  const double tolerance_m = 3.0 * frame.states.geometry().voxel_size_m;
  if (auto mark = nearestMark(marks, eye, at_px, picture, solid ? solid->distance_m : kFar, tolerance_m))
    return mark;
  if (!solid) return std::nullopt;
  Picked picked{PickedKind::Voxel, ray.origin + solid->distance_m * ray.direction, solid->distance_m};
  picked.voxel = solid->voxel;
  picked.state = solid->state;
  if (solid->state != VoxelState::Occupied) return picked;
  if (const auto label = labelNear(frame, picked.p_world)) {
    picked.kind = PickedKind::Segment;
    picked.id = *label;
  }
  return picked;
}

/// Label of the nearest point of the surface within two voxels; nothing if it has none.
std::optional<std::uint32_t> Picker::labelNear(const SceneFrame& frame, const Eigen::Vector3d& p_world) {
  const StepRecord& record = frame.record;
  if (!record.surface || !record.labels) return std::nullopt;
  if (surface_ != record.surface) {
    nearest_ = std::make_unique<NearestPoint>(record.surface->points);
    surface_ = record.surface;
  }
  const auto index = (*nearest_)(p_world);
  if (!index || *index >= record.labels->of_point.size()) return std::nullopt;
  const double distance_m = (record.surface->points[*index].cast<double>() - p_world).norm();
  const std::uint32_t label = record.labels->of_point[*index];
  if (label == 0 || distance_m > 2.0 * frame.states.geometry().voxel_size_m) return std::nullopt;
  return label;
}

}  // namespace vantage
