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
                        shown.has(Layer::Segments) || shown.has(Layer::SegmentLabels);
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
  std::optional<FrustumCorners> frustum = {};  ///< its lines are drawn
};

void addViews(const SceneFrame& frame, const ViewSettings& settings, std::vector<Mark>& marks) {
  const StepRecord& record = frame.record;
  const PinholeCamera camera = viewCamera(frame);
  const auto add = [&](std::uint32_t id, const Pose& pose) {
    marks.push_back({PickedKind::Frustum, id, pose.translation()});
  };
  const auto addDrawn = [&](std::uint32_t id, const Pose& pose, double length_m) {
    marks.push_back({PickedKind::Frustum, id, pose.translation(), frustumCorners(camera, pose, length_m)});
  };
  if (settings.layers.has(Layer::ChosenView) && record.hasView())
    addDrawn(record.chosen()->id, record.chosen()->T_world_camera, chosenFrustumLength(frame));
  if (settings.layers.has(Layer::RankedViews)) {
    for (const RankedPosition& view : drawnViews(frame, settings.style))
      addDrawn(view.id, view.T_world_camera, settings.style.frustum_length_m);
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

/// A point of the picture, and what may hide things there.
struct Aim {
  const Eye& eye;
  Eigen::Vector2d at_px;
  PictureSize picture;
  double farthest_m;  ///< what lies farther from the eye is hidden
};

/// How far from the aim a point appears, as a share of the radius; at least 1: too far, or hidden.
double shareOfPoint(const Aim& aim, const Eigen::Vector3d& p_world, double radius_px) {
  const auto pixel = pixelOf(aim.eye, p_world, aim.picture);
  if (!pixel || (p_world - aim.eye.position).norm() > aim.farthest_m) return 1.0;
  return (*pixel - aim.at_px).norm() / radius_px;
}

/// The same of a straight piece, by its point that appears nearest.
double shareOfLine(const Aim& aim, const Eigen::Vector3d& a_world, const Eigen::Vector3d& b_world,
                   double radius_px) {
  const auto a = pixelOf(aim.eye, a_world, aim.picture), b = pixelOf(aim.eye, b_world, aim.picture);
  if (!a || !b) return 1.0;
  const Eigen::Vector2d along = *b - *a;
  const double t = std::clamp((aim.at_px - *a).dot(along) / std::max(1e-12, along.squaredNorm()), 0.0, 1.0);
  const double distance_m = ((1.0 - t) * a_world + t * b_world - aim.eye.position).norm();
  if (distance_m > aim.farthest_m) return 1.0;
  return (*a + t * along - aim.at_px).norm() / radius_px;
}

/// Apexes count before lines, which cross each other.
double shareOf(const Aim& aim, const Mark& mark) {
  if (mark.kind != PickedKind::Frustum) return shareOfPoint(aim, mark.p_world, Picker::kContourRadius_px);
  const double apex = shareOfPoint(aim, mark.p_world, Picker::kFrustumRadius_px);
  if (apex < 1.0) return 0.5 * apex;
  if (!mark.frustum) return 1.0;
  double nearest = 1.0;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d &corner = mark.frustum->image[i], &next = mark.frustum->image[(i + 1) % 4];
    nearest = std::min({nearest, shareOfLine(aim, mark.p_world, corner, Picker::kEdgeRadius_px),
                        shareOfLine(aim, corner, next, Picker::kEdgeRadius_px)});
  }
  return 0.5 + 0.5 * nearest;
}

/// The mark nearest to the aim, of equally near ones the first.
std::optional<Picked> nearestMark(const std::vector<Mark>& marks, const Aim& aim) {
  std::optional<Picked> nearest;
  double best = 1.0;
  for (const Mark& mark : marks) {
    const double share = shareOf(aim, mark);
    if (share >= best) continue;
    best = share;
    nearest = Picked{mark.kind, mark.p_world, (mark.p_world - aim.eye.position).norm(), mark.id};
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
  const double farthest_m = solid ? solid->distance_m + tolerance_m : kFar;
  if (auto mark = nearestMark(marks, {eye, at_px, picture, farthest_m})) return mark;
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
