#include "viewer/page.h"

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkCoordinate.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>
#include <vtkTexture.h>
#include <vtkTexturedActor2D.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <numbers>
#include <sstream>

#include "viewer/vtk_messages.h"

namespace vantage {
namespace {

constexpr int kDotsPerInch = 72;  // one point is one pixel

void apply(const TextStyle& style, vtkTextProperty& property) {
  property.SetFontFamilyToArial();
  property.SetFontSize(style.size_px);
  property.SetBold(style.bold);
  property.SetColor(style.color.r, style.color.g, style.color.b);
  switch (style.horizontal) {
    case HorizontalAlign::Left:
      property.SetJustificationToLeft();
      break;
    case HorizontalAlign::Center:
      property.SetJustificationToCentered();
      break;
    case HorizontalAlign::Right:
      property.SetJustificationToRight();
      break;
  }
  switch (style.vertical) {
    case VerticalAlign::Top:
      property.SetVerticalJustificationToTop();
      break;
    case VerticalAlign::Middle:
      property.SetVerticalJustificationToCentered();
      break;
    case VerticalAlign::Baseline:
      property.SetVerticalJustificationToBottom();
      break;
  }
}

vtkSmartPointer<vtkActor2D> flatActor(vtkPolyData* data, Rgb color, double opacity) {
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(data);
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor2D>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(color.r, color.g, color.b);
  actor->GetProperty()->SetOpacity(opacity);
  return actor;
}

}  // namespace

Page::Page(int width, int height, Rgb background)
    : width_(width), height_(height), renderer_(vtkSmartPointer<vtkRenderer>::New()) {
  silenceVtk();
  renderer_->SetBackground(background.r, background.g, background.b);
  renderer_->InteractiveOff();
}

Page::~Page() = default;

vtkRenderer* Page::renderer() const {
  return renderer_;
}

void Page::text(double x, double y, const std::string& utf8, const TextStyle& style) {
  if (utf8.empty()) return;
  vtkNew<vtkTextActor> actor;
  actor->SetInput(utf8.c_str());
  apply(style, *actor->GetTextProperty());
  actor->GetPositionCoordinate()->SetCoordinateSystemToDisplay();
  actor->SetPosition(std::round(x), std::round(height_ - y));
  renderer_->AddActor2D(actor);
}

double Page::paragraph(double x, double y, double width_px, const std::string& utf8, const TextStyle& style) {
  for (const std::string& line : wrapText(utf8, width_px, style)) {
    text(x, y, line, style);
    y += std::round(style.size_px * 1.35);
  }
  return y;
}

void Page::polygon(std::span<const double> xy, Rgb color, double opacity) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(static_cast<int>(xy.size() / 2));
  for (std::size_t i = 0; i + 1 < xy.size(); i += 2) {
    cells->InsertCellPoint(points->InsertNextPoint(xy[i], height_ - xy[i + 1], 0.0));
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  renderer_->AddActor2D(flatActor(data, color, opacity));
}

void Page::rectangle(double x, double y, double w, double h, Rgb color, double opacity) {
  polygon(std::array{x, y, x + w, y, x + w, y + h, x, y + h}, color, opacity);
}

void Page::frame(double x, double y, double w, double h, Rgb color, double width_px) {
  rectangle(x - width_px, y - width_px, w + 2 * width_px, width_px, color);
  rectangle(x - width_px, y + h, w + 2 * width_px, width_px, color);
  rectangle(x - width_px, y, width_px, h, color);
  rectangle(x + w, y, width_px, h, color);
}

void Page::line(double x0, double y0, double x1, double y1, Rgb color, double width_px) {
  const double length = std::hypot(x1 - x0, y1 - y0);
  if (length <= 0.0) return;
  const double nx = -(y1 - y0) / length * width_px / 2, ny = (x1 - x0) / length * width_px / 2;
  polygon(std::array{x0 + nx, y0 + ny, x1 + nx, y1 + ny, x1 - nx, y1 - ny, x0 - nx, y0 - ny}, color, 1.0);
}

void Page::disc(double x, double y, double radius, Rgb color) {
  constexpr int kCorners = 24;
  std::vector<double> xy;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    xy.insert(xy.end(), {x + radius * std::cos(angle), y + radius * std::sin(angle)});
  }
  polygon(xy, color, 1.0);
}

void Page::colorStrip(double x, double y, double w, double h, ColorMap map) {
  RgbImage strip(256, 1);
  for (int i = 0; i < strip.width; ++i) strip.set(i, 0, colorAt(map, i / 255.0).bytes());
  picture(x, y, w, h, strip);
}

void Page::picture(double x, double y, double w, double h, const RgbImage& image) {
  if (image.empty()) return;
  vtkNew<vtkImageData> data;
  data->SetDimensions(image.width, image.height, 1);
  data->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  std::memcpy(data->GetScalarPointer(), image.pixels.data(), image.pixels.size());
  vtkNew<vtkTexture> texture;
  texture->SetInputData(data);
  texture->SetColorModeToDirectScalars();
  texture->SetInterpolate(w != image.width || h != image.height);

  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> coordinates;
  coordinates->SetNumberOfComponents(2);
  coordinates->SetName("uv");
  const std::array<std::array<double, 2>, 4> corners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(4);
  for (const auto& [u, v] : corners) {
    cells->InsertCellPoint(points->InsertNextPoint(x + u * w, height_ - y - v * h, 0.0));
    coordinates->InsertNextTuple2(u, v);  // row 0 of the texture is the picture's top
  }
  vtkNew<vtkPolyData> quad;
  quad->SetPoints(points);
  quad->SetPolys(cells);
  quad->GetPointData()->SetTCoords(coordinates);
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(quad);
  vtkNew<vtkTexturedActor2D> actor;
  actor->SetMapper(mapper);
  actor->SetTexture(texture);
  renderer_->AddActor2D(actor);
}

double textWidth(const std::string& utf8, const TextStyle& style) {
  vtkNew<vtkTextProperty> property;
  apply(style, *property);
  int box[4] = {0, 0, 0, 0};
  vtkTextRenderer* renderer = vtkTextRenderer::GetInstance();
  if (!renderer || !renderer->GetBoundingBox(property, utf8, box, kDotsPerInch)) return 0.0;
  return box[1] - box[0] + 1;
}

std::vector<std::string> wrapText(const std::string& utf8, double width_px, const TextStyle& style) {
  std::vector<std::string> lines;
  std::istringstream words(utf8);
  std::string line;
  std::vector<std::string> parts;
  for (std::string word; words >> word;) {
    // A number with blanks between its thousands and its unit stay on one line.
    const bool after_digit = !parts.empty() && std::isdigit(static_cast<unsigned char>(parts.back().back()));
    const auto digit = [](unsigned char c) { return std::isdigit(c) != 0; };
    const std::string bare = word.substr(0, word.find_last_not_of(".,;:)") + 1);
    const bool number =
        after_digit && ((word.size() >= 3 && std::all_of(word.begin(), word.begin() + 3, digit)) ||
                        bare == "m" || bare == "cm" || bare == "mm");
    if (number) {
      parts.back() += " " + word;
    } else {
      parts.push_back(word);
    }
  }
  for (const std::string& word : parts) {
    const std::string longer = line.empty() ? word : line + " " + word;
    if (!line.empty() && textWidth(longer, style) > width_px) {
      lines.push_back(line);
      line = word;
    } else {
      line = longer;
    }
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

}  // namespace vantage
