// Voxel states: occupied, the frontier of unknown space, free space, and slices through all of them.
#include <vtkActor.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPlaneSource.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTexture.h>

#include <algorithm>
#include <optional>

#include "viewer/layers/layer.h"
#include "viewer/layers/shapes.h"

namespace vantage {
namespace {

LayerContent faceLayer(const SceneFrame& frame, VoxelState state, FaceRule rule, const Box& clip, Rgb color,
                       double opacity, const std::string& legend) {
  LayerContent content;
  const MergedFaces faces = extractMergedFaces(frame.states, state, rule, clip);
  if (faces.empty()) return content;
  auto actor = faceActor(faces, color, opacity);
  content.props.push_back(actor);
  content.legend.push_back({LegendEntry::Mark::Fill, color, opacity < 1.0 ? 0.45 : 1.0, legend});
  return content;
}

/// A plane of voxels: those from `first` to `last`, which are equal along `axis`.
struct VoxelPlane {
  int axis = 0, u = 1, v = 2;  ///< normal, and the axes of its picture
  Eigen::Vector3i first = Eigen::Vector3i::Zero(), last = Eigen::Vector3i::Zero();
};

/// A slice across an axis within the workspace; nothing if it misses the workspace or the grid.
std::optional<VoxelPlane> planeOf(const SceneFrame& frame, int axis, const SlicePlane& slice) {
  const GridGeometry& geometry = frame.states.geometry();
  Box bounds = slicedBox(frame);
  if (bounds.isEmpty()) return std::nullopt;
  VoxelPlane plane{axis, (axis + 1) % 3, (axis + 2) % 3};
  const double at_m = slice.at_m.value_or(bounds.center()[plane.axis]);
  if (at_m < bounds.min()[plane.axis] || at_m > bounds.max()[plane.axis]) return std::nullopt;
  bounds.min()[plane.axis] = bounds.max()[plane.axis] = at_m;
  const Eigen::Vector3i largest(geometry.size[0] - 1, geometry.size[1] - 1, geometry.size[2] - 1);
  plane.first = geometry.voxelAt(bounds.min()).cwiseMax(0).cwiseMin(largest);
  plane.last = geometry.voxelAt(bounds.max()).cwiseMax(0).cwiseMin(largest);
  return plane;
}

/// States on the plane as a picture: u to the right, v up.
vtkSmartPointer<vtkImageData> sliceImage(const StateGrid& grid, const VoxelPlane& plane) {
  const GridGeometry& geometry = grid.geometry();
  const std::array<std::array<std::uint8_t, 3>, 3> colors = {
      palette::kUnknown.bytes(), palette::kFree.bytes(), palette::kOccupied.bytes()};
  const Eigen::Vector3i size = plane.last - plane.first + Eigen::Vector3i::Ones();
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(size[plane.u], size[plane.v], 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* out = static_cast<std::uint8_t*>(image->GetScalarPointer());
  Eigen::Vector3i voxel = plane.first;
  for (voxel[plane.v] = plane.first[plane.v]; voxel[plane.v] <= plane.last[plane.v]; ++voxel[plane.v]) {
    for (voxel[plane.u] = plane.first[plane.u]; voxel[plane.u] <= plane.last[plane.u]; ++voxel[plane.u]) {
      const auto& color = colors[grid.states()[geometry.index(voxel)] % 3];
      out = std::copy(color.begin(), color.end(), out);
    }
  }
  return image;
}

/// The plane in the colours of its voxels.
vtkSmartPointer<vtkActor> sliceActor(const StateGrid& grid, const VoxelPlane& voxels) {
  const GridGeometry& geometry = grid.geometry();
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(geometry.voxel_size_m / 2);
  const Eigen::Vector3d low = geometry.center(voxels.first) - half,
                        high = geometry.center(voxels.last) + half;
  Eigen::Vector3d origin = low;
  origin[voxels.axis] = geometry.center(voxels.first)[voxels.axis];
  Eigen::Vector3d end_u = origin, end_v = origin;
  end_u[voxels.u] = high[voxels.u];
  end_v[voxels.v] = high[voxels.v];
  vtkNew<vtkPlaneSource> plane;
  plane->SetOrigin(origin.data());
  plane->SetPoint1(end_u.data());
  plane->SetPoint2(end_v.data());
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(plane->GetOutputPort());
  vtkNew<vtkTexture> texture;
  texture->SetInputData(sliceImage(grid, voxels));
  texture->SetColorModeToDirectScalars();
  texture->InterpolateOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->SetTexture(texture);
  actor->GetProperty()->LightingOff();
  return actor;
}

}  // namespace

LayerContent occupiedLayer(const SceneFrame& frame, const LayerStyle&) {
  LayerContent content = faceLayer(frame, VoxelState::Occupied, FaceRule::TowardOther, occupiedBox(frame),
                                   palette::kOccupied, 1.0, "occupied voxels");
  // Nobody sees the inside of closed bodies.
  if (!content.props.empty())
    vtkActor::SafeDownCast(content.props.front())->GetProperty()->BackfaceCullingOn();
  return content;
}

LayerContent unknownLayer(const SceneFrame& frame, const LayerStyle& style) {
  // Seen from its free side the frontier has the full opacity; seen from behind, where it would curtain the
  // scene off, a third.
  constexpr double kBehind = 0.3;
  LayerContent content = faceLayer(frame, VoxelState::Unknown, FaceRule::TowardFree, frame.header.workspace,
                                   palette::kUnknown, style.unknown_opacity, "frontier of unknown space");
  if (content.props.empty()) return content;
  vtkActor* front = vtkActor::SafeDownCast(content.props.front());
  front->GetProperty()->BackfaceCullingOn();
  vtkNew<vtkActor> behind;
  behind->SetMapper(front->GetMapper());
  behind->GetProperty()->DeepCopy(front->GetProperty());
  behind->GetProperty()->BackfaceCullingOff();
  behind->GetProperty()->FrontfaceCullingOn();
  behind->GetProperty()->SetOpacity(kBehind * style.unknown_opacity);
  content.props.push_back(behind);
  content.fine_props = 1;
  return content;
}

LayerContent freeLayer(const SceneFrame& frame, const LayerStyle& style) {
  return faceLayer(frame, VoxelState::Free, FaceRule::TowardOther, frame.header.workspace, palette::kFree,
                   style.free_opacity, "free space");
}

LayerContent slicesLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  for (int axis = 0; axis < 3; ++axis) {
    if (!style.slices[axis].shown) continue;
    if (const auto voxels = planeOf(frame, axis, style.slices[axis]))
      content.props.push_back(sliceActor(frame.states, *voxels));
  }
  if (content.props.empty()) return content;
  content.legend = {{LegendEntry::Mark::Fill, palette::kUnknown, 1.0, "unknown (slice)"},
                    {LegendEntry::Mark::Fill, palette::kFree, 1.0, "free (slice)"},
                    {LegendEntry::Mark::Fill, palette::kOccupied, 1.0, "occupied (slice)"}};
  return content;
}

}  // namespace vantage
