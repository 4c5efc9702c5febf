#include "viewer/layers/shapes.h"

#include <vtkBillboardTextActor3D.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCoordinate.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkTexture.h>
#include <vtkTubeFilter.h>
#include <vtkTypeInt32Array.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace vantage {
namespace {

vtkSmartPointer<vtkActor> makeActor(vtkPolyData* data, Rgb color) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  const bool colored = data->GetPointData()->GetScalars() || data->GetCellData()->GetScalars();
  mapper->SetScalarVisibility(colored);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(color.r, color.g, color.b);
  return actor;
}

vtkSmartPointer<vtkPoints> toPoints(const std::vector<Eigen::Vector3f>& in) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  vtkNew<vtkFloatArray> values;
  values->SetNumberOfComponents(3);
  values->SetNumberOfTuples(static_cast<vtkIdType>(in.size()));
  if (!in.empty()) std::memcpy(values->GetPointer(0), in.data(), in.size() * sizeof(Eigen::Vector3f));
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetData(values);
  return points;
}

/// Cells of N corners each, without a copy per cell.
template <std::size_t N>
vtkSmartPointer<vtkCellArray> toCells(const std::vector<std::array<std::uint32_t, N>>& in) {
  vtkNew<vtkTypeInt32Array> offsets, corners;
  offsets->SetNumberOfValues(static_cast<vtkIdType>(in.size() + 1));
  corners->SetNumberOfValues(static_cast<vtkIdType>(in.size() * N));
  for (std::size_t i = 0; i <= in.size(); ++i)
    offsets->SetValue(static_cast<vtkIdType>(i), static_cast<int>(i * N));
  if (!in.empty()) std::memcpy(corners->GetPointer(0), in.data(), in.size() * N * sizeof(std::uint32_t));
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, corners);
  return cells;
}

vtkSmartPointer<vtkUnsignedCharArray> toColors(std::size_t count, auto&& bytes_of) {
  auto colors = vtkSmartPointer<vtkUnsignedCharArray>::New();
  colors->SetNumberOfComponents(3);
  colors->SetNumberOfTuples(static_cast<vtkIdType>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const std::array<std::uint8_t, 3> bytes = bytes_of(i);
    colors->SetTypedTuple(static_cast<vtkIdType>(i), bytes.data());
  }
  return colors;
}

void styleLabel(vtkTextProperty& text, double size_px, Rgb color) {
  text.SetFontFamilyToArial();
  text.SetFontSize(static_cast<int>(std::lround(size_px)));
  text.SetBold(true);
  text.SetColor(color.r, color.g, color.b);
  text.SetJustificationToCentered();
  text.SetVerticalJustificationToCentered();
}

}  // namespace

void LineSet::addDashed(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double dash_m) {
  const double length = (b - a).norm();
  const int dashes = std::max(1, static_cast<int>(std::ceil(length / (2.0 * dash_m))));
  for (int i = 0; i < dashes; ++i) {
    const double from = static_cast<double>(i) / dashes, to = (i + 0.55) / dashes;
    add(a + from * (b - a), a + to * (b - a));
  }
}

void LineSet::addCircle(const Eigen::Vector3d& center, double radius_m, const Eigen::Vector3d& axis) {
  constexpr int kPieces = 72;
  const Eigen::Vector3d u = axis.unitOrthogonal(), v = axis.normalized().cross(u);
  const auto at = [&](int i) {
    const double angle = 2.0 * std::numbers::pi * i / kPieces;
    return Eigen::Vector3d(center + radius_m * (std::cos(angle) * u + std::sin(angle) * v));
  };
  for (int i = 0; i < kPieces; ++i) add(at(i), at(i + 1));
}

void addBox(LineSet& lines, const Box& box) {
  for (int c = 0; c < 8; ++c) {
    for (int axis = 0; axis < 3; ++axis) {
      if (c & (1 << axis)) continue;
      lines.add(box.corner(static_cast<Box::CornerType>(c)),
                box.corner(static_cast<Box::CornerType>(c | (1 << axis))));
    }
  }
}

void addEdges(LineSet& lines, const FaceMesh& faces) {
  for (const auto& [a, b] : edgesOf(faces))
    lines.add(faces.corners[a].cast<double>(), faces.corners[b].cast<double>());
}

vtkSmartPointer<vtkActor> lineActor(const LineSet& lines, Rgb color, double width_px, double opacity) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  for (const auto& [a, b] : lines.pieces) {
    const vtkIdType ids[2] = {points->InsertNextPoint(a.data()), points->InsertNextPoint(b.data())};
    cells->InsertNextCell(2, ids);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(cells);
  if (!lines.colors.empty()) {
    data->GetCellData()->SetScalars(
        toColors(lines.colors.size(), [&](std::size_t i) { return lines.colors[i].bytes(); }));
  }
  auto actor = makeActor(data, color);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetLineWidth(static_cast<float>(width_px));
  actor->GetProperty()->SetOpacity(opacity);
  return actor;
}

vtkSmartPointer<vtkActor> dotActor(const std::vector<Eigen::Vector3d>& points_world,
                                   const std::vector<Rgb>& colors, Rgb color, double size_px) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  for (const Eigen::Vector3d& p : points_world) {
    const vtkIdType id = points->InsertNextPoint(p.data());
    cells->InsertNextCell(1, &id);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetVerts(cells);
  if (!colors.empty()) {
    data->GetPointData()->SetScalars(
        toColors(colors.size(), [&](std::size_t i) { return colors[i].bytes(); }));
  }
  auto actor = makeActor(data, color);
  actor->GetProperty()->SetPointSize(static_cast<float>(size_px));
  actor->GetProperty()->RenderPointsAsSpheresOn();
  actor->GetProperty()->SetAmbient(0.35);
  actor->GetProperty()->SetDiffuse(0.65);
  return actor;
}

vtkSmartPointer<vtkActor> tubeActor(const std::vector<Eigen::Vector3d>& line, double radius_m, Rgb color) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(static_cast<int>(line.size()));
  for (const Eigen::Vector3d& p : line) cells->InsertCellPoint(points->InsertNextPoint(p.data()));
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(cells);
  vtkNew<vtkTubeFilter> tube;
  tube->SetInputData(data);
  tube->SetRadius(radius_m);
  tube->SetNumberOfSides(16);
  tube->CappingOn();
  tube->Update();
  auto actor = makeActor(tube->GetOutput(), color);
  actor->GetProperty()->SetAmbient(0.45);
  actor->GetProperty()->SetDiffuse(0.65);
  return actor;
}

vtkSmartPointer<vtkActor> ballActor(const Eigen::Vector3d& center, double radius_m, Rgb color) {
  vtkNew<vtkSphereSource> ball;
  ball->SetCenter(center.x(), center.y(), center.z());
  ball->SetRadius(radius_m);
  ball->SetThetaResolution(24);
  ball->SetPhiResolution(16);
  ball->Update();
  auto actor = makeActor(ball->GetOutput(), color);
  actor->GetProperty()->SetAmbient(0.45);
  actor->GetProperty()->SetDiffuse(0.65);
  return actor;
}

namespace {

vtkSmartPointer<vtkActor> flatActor(vtkPolyData* data, Rgb color, double opacity) {
  auto actor = makeActor(data, color);
  actor->GetProperty()->SetInterpolationToFlat();
  actor->GetProperty()->SetOpacity(opacity);
  // Translucent faces keep their colour from all sides: they say "unknown", not which way they look.
  actor->GetProperty()->SetAmbient(opacity < 1.0 ? 0.75 : 0.35);
  actor->GetProperty()->SetDiffuse(opacity < 1.0 ? 0.30 : 0.75);
  return actor;
}

}  // namespace

vtkSmartPointer<vtkActor> faceActor(const FaceMesh& faces, Rgb color, double opacity) {
  vtkNew<vtkPolyData> data;
  data->SetPoints(toPoints(faces.corners));
  data->SetPolys(toCells(faces.quads));
  return flatActor(data, color, opacity);
}

vtkSmartPointer<vtkActor> faceActor(const MergedFaces& faces, Rgb color, double opacity) {
  vtkNew<vtkPolyData> data;
  data->SetPoints(toPoints(faces.corners));
  data->SetPolys(toCells(faces.triangles));
  return flatActor(data, color, opacity);
}

vtkSmartPointer<vtkActor> hatchedActor(const FaceMesh& faces, Rgb color, double period_m) {
  constexpr int kTexels = 16, kDark = 6;
  vtkNew<vtkImageData> stripes;
  stripes->SetDimensions(kTexels, 1, 1);
  stripes->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const auto light = color.bytes(), dark = palette::kInk.bytes();
  auto* texel = static_cast<std::uint8_t*>(stripes->GetScalarPointer());
  for (int n = 0; n < kTexels; ++n) texel = std::copy_n((n < kDark ? dark : light).begin(), 3, texel);
  vtkNew<vtkTexture> texture;
  texture->SetInputData(stripes);
  texture->SetColorModeToDirectScalars();
  texture->InterpolateOn();
  texture->RepeatOn();
  vtkNew<vtkFloatArray> along;  // x + y + z: lines of equal values cross every axis-aligned face diagonally
  along->SetNumberOfComponents(2);
  along->SetNumberOfTuples(static_cast<vtkIdType>(faces.corners.size()));
  for (std::size_t n = 0; n < faces.corners.size(); ++n)
    along->SetTuple2(static_cast<vtkIdType>(n), faces.corners[n].sum() / period_m, 0.5);
  vtkNew<vtkPolyData> data;
  data->SetPoints(toPoints(faces.corners));
  data->SetPolys(toCells(faces.quads));
  data->GetPointData()->SetTCoords(along);
  auto actor = flatActor(data, rgb(255, 255, 255), 1.0);
  actor->SetTexture(texture);
  constexpr double kTowardEye = -60.0;  // about a centimetre in a scene of metres
  actor->GetMapper()->SetResolveCoincidentTopologyToPolygonOffset();
  actor->GetMapper()->SetRelativeCoincidentTopologyPolygonOffsetParameters(0.0, kTowardEye);
  return actor;
}

vtkSmartPointer<vtkActor> triangleActor(const std::vector<Eigen::Vector3f>& points,
                                        const std::vector<Eigen::Vector3f>& normals,
                                        const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                        const std::vector<std::array<std::uint8_t, 3>>& colors, Rgb color,
                                        double opacity) {
  vtkNew<vtkPolyData> data;
  data->SetPoints(toPoints(points));
  data->SetPolys(toCells(triangles));
  if (!normals.empty() && normals.size() == points.size()) {
    vtkNew<vtkFloatArray> values;
    values->SetNumberOfComponents(3);
    values->SetNumberOfTuples(static_cast<vtkIdType>(normals.size()));
    std::memcpy(values->GetPointer(0), normals.data(), normals.size() * sizeof(Eigen::Vector3f));
    data->GetPointData()->SetNormals(values);
  }
  if (!colors.empty()) {
    const auto scalars = toColors(colors.size(), [&](std::size_t i) { return colors[i]; });
    if (colors.size() == points.size()) {
      data->GetPointData()->SetScalars(scalars);
    } else if (colors.size() == triangles.size()) {
      data->GetCellData()->SetScalars(scalars);
    }
  }
  auto actor = makeActor(data, color);
  if (normals.empty()) actor->GetProperty()->SetInterpolationToFlat();
  actor->GetProperty()->SetOpacity(opacity);
  actor->GetProperty()->SetAmbient(0.32);
  actor->GetProperty()->SetDiffuse(0.80);
  return actor;
}

vtkSmartPointer<vtkActor> flatTriangleActor(const std::vector<Eigen::Vector3f>& points,
                                            const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                            const std::vector<Rgb>& colors, FaceSide side, double opacity) {
  vtkNew<vtkPolyData> data;
  data->SetPoints(toPoints(points));
  data->SetPolys(toCells(triangles));
  data->GetCellData()->SetScalars(toColors(colors.size(), [&](std::size_t i) { return colors[i].bytes(); }));
  auto actor = makeActor(data, palette::kInk);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetOpacity(opacity);
  actor->GetProperty()->SetBackfaceCulling(side == FaceSide::TowardEye);
  actor->GetProperty()->SetFrontfaceCulling(side == FaceSide::AwayFromEye);
  return actor;
}

vtkSmartPointer<vtkProp> labelProp(const Eigen::Vector3d& at, const std::string& utf8, double size_px,
                                   Rgb color) {
  auto label = vtkSmartPointer<vtkBillboardTextActor3D>::New();
  label->SetPosition(at.x(), at.y(), at.z());
  label->SetInput(utf8.c_str());
  styleLabel(*label->GetTextProperty(), size_px, color);
  return label;
}

vtkSmartPointer<vtkProp> plateProp(const Eigen::Vector3d& at, const std::string& utf8, double size_px,
                                   Rgb color) {
  auto label = vtkSmartPointer<vtkTextActor>::New();
  label->GetPositionCoordinate()->SetCoordinateSystemToWorld();
  label->GetPositionCoordinate()->SetValue(at.x(), at.y(), at.z());
  label->SetInput((" " + utf8 + " ").c_str());
  vtkTextProperty* text = label->GetTextProperty();
  styleLabel(*text, size_px, color);
  text->SetBackgroundColor(1.0, 1.0, 1.0);
  text->SetBackgroundOpacity(1.0);
  text->SetFrame(true);
  text->SetFrameColor(color.r, color.g, color.b);
  return label;
}

void addFrustum(LineSet& lines, const PinholeCamera& camera, const Pose& T_world_camera, double depth_m) {
  const FrustumCorners corners = frustumCorners(camera, T_world_camera, depth_m);
  for (int i = 0; i < 4; ++i) {
    lines.add(corners.apex, corners.image[i]);
    lines.add(corners.image[i], corners.image[(i + 1) % 4]);
  }
}

}  // namespace vantage
