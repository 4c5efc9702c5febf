// Voxel states: occupied, the frontier of unknown space, free space, and slices through all of them.
#include <vtkActor.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPlaneSource.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTexture.h>

#include <algorithm>
#include <cmath>

#include "viewer/layers/layer.h"
#include "viewer/layers/shapes.h"

namespace vantage {
namespace {

constexpr double kSupportMargin_m = 0.04;  ///< occupied voxels just under the workspace are its floor

LayerContent faceLayer(const SceneFrame& frame, VoxelState state, FaceRule rule, const Box& clip, Rgb color,
                       double opacity, const std::string& legend) {
  LayerContent content;
  const FaceMesh faces = extractFaces(frame.states, state, rule, clip);
  if (faces.empty()) return content;
  auto actor = faceActor(faces, color, opacity);
  content.props.push_back(actor);
  content.legend.push_back({LegendEntry::Mark::Fill, color, opacity < 1.0 ? 0.45 : 1.0, legend});
  return content;
}

/// States on one plane of the grid as a picture: u along the first other axis, v along the second.
vtkSmartPointer<vtkImageData> sliceImage(const StateGrid& grid, int axis, int index) {
  const GridGeometry& geometry = grid.geometry();
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const std::array<std::array<std::uint8_t, 3>, 3> colors = {
      palette::kUnknown.bytes(), palette::kFree.bytes(), palette::kOccupied.bytes()};
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(geometry.size[u], geometry.size[v], 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* out = static_cast<std::uint8_t*>(image->GetScalarPointer());
  Eigen::Vector3i voxel;
  voxel[axis] = index;
  for (voxel[v] = 0; voxel[v] < geometry.size[v]; ++voxel[v]) {
    for (voxel[u] = 0; voxel[u] < geometry.size[u]; ++voxel[u]) {
      const auto& color = colors[grid.states()[geometry.index(voxel)] % 3];
      out = std::copy(color.begin(), color.end(), out);
    }
  }
  return image;
}

}  // namespace

LayerContent occupiedLayer(const SceneFrame& frame, const LayerStyle&) {
  Box clip = frame.header.workspace;
  if (!clip.isEmpty()) clip.min().z() -= kSupportMargin_m;
  return faceLayer(frame, VoxelState::Occupied, FaceRule::TowardOther, clip, palette::kOccupied, 1.0,
                   "occupied voxels");
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
  return content;
}

LayerContent freeLayer(const SceneFrame& frame, const LayerStyle& style) {
  return faceLayer(frame, VoxelState::Free, FaceRule::TowardOther, frame.header.workspace, palette::kFree,
                   style.free_opacity, "free space");
}

LayerContent slicesLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  const GridGeometry& geometry = frame.states.geometry();
  if (geometry.count() == 0) return content;
  const int axis = style.slice_axis, u = (axis + 1) % 3, v = (axis + 2) % 3;
  Eigen::Vector3d at = geometry.origin_m;
  at[axis] = style.slice_at_m;
  const int index = geometry.voxelAt(at)[axis];
  if (index < 0 || index >= geometry.size[axis]) return content;

  const Box bounds = geometry.bounds();
  Eigen::Vector3d origin = bounds.min(), end_u = bounds.min(), end_v = bounds.min();
  origin[axis] = end_u[axis] = end_v[axis] = style.slice_at_m;
  end_u[u] = bounds.max()[u];
  end_v[v] = bounds.max()[v];
  vtkNew<vtkPlaneSource> plane;
  plane->SetOrigin(origin.data());
  plane->SetPoint1(end_u.data());
  plane->SetPoint2(end_v.data());
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(plane->GetOutputPort());
  vtkNew<vtkTexture> texture;
  texture->SetInputData(sliceImage(frame.states, axis, index));
  texture->SetColorModeToDirectScalars();
  texture->InterpolateOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->SetTexture(texture);
  actor->GetProperty()->LightingOff();
  content.props.push_back(actor);
  content.legend = {{LegendEntry::Mark::Fill, palette::kUnknown, 1.0, "unknown (slice)"},
                    {LegendEntry::Mark::Fill, palette::kFree, 1.0, "free (slice)"},
                    {LegendEntry::Mark::Fill, palette::kOccupied, 1.0, "occupied (slice)"}};
  return content;
}

}  // namespace vantage
