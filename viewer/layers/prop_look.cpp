// What changes on a layer's props after they were built: visibility, opacity, sizes, clipping, theme.
#include "viewer/layers/prop_look.h"

#include <vtkActor.h>
#include <vtkBillboardTextActor3D.h>
#include <vtkCellData.h>
#include <vtkCoordinate.h>
#include <vtkMapper.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

/// Relative luminance (WCAG 2).
double luminance(Rgb color) {
  const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(color.r) + 0.7152 * linear(color.g) + 0.0722 * linear(color.b);
}

double contrast(Rgb a, Rgb b) {
  const double la = luminance(a) + 0.05, lb = luminance(b) + 0.05;
  return std::max(la, lb) / std::min(la, lb);
}

vtkTextProperty* lettersOf(vtkProp* prop) {
  if (auto* label = vtkBillboardTextActor3D::SafeDownCast(prop)) return label->GetTextProperty();
  if (auto* plate = vtkTextActor::SafeDownCast(prop)) return plate->GetTextProperty();
  return nullptr;
}

/// Lines and points of one colour.
bool isDrawing(vtkActor* actor) {
  auto* data = vtkPolyData::SafeDownCast(actor->GetMapper() ? actor->GetMapper()->GetInput() : nullptr);
  return data && data->GetNumberOfPolys() == 0 && !data->GetPointData()->GetScalars() &&
         !data->GetCellData()->GetScalars();
}

/// A plate has its own white ground.
bool isPlate(vtkProp* prop) {
  return vtkTextActor::SafeDownCast(prop) != nullptr;
}

Eigen::Vector3d placeOf(vtkTextActor* plate) {
  return Eigen::Vector3d(plate->GetPositionCoordinate()->GetValue());
}

}  // namespace

Rgb readable(Rgb color, const SceneTheme& theme) {
  constexpr double kEnough = 3.0, kFaint = 2.0;
  const double on_paper = contrast(color, palette::kPaper), wanted = std::min(kEnough, on_paper);
  const bool faint = on_paper < kFaint;
  const auto fits = [&](Rgb mixed) {
    const double here = contrast(mixed, theme.background);
    return here >= wanted && (!faint || here <= 2.0 * on_paper);
  };
  // Toward the ink if it is lost in the background, toward the background if a faint colour shouts.
  const Rgb& end = contrast(color, theme.background) < wanted ? theme.ink : theme.background;
  for (int step = 0; step <= 40; ++step) {
    const double f = step / 40.0;
    const Rgb mixed{color.r + f * (end.r - color.r), color.g + f * (end.g - color.g),
                    color.b + f * (end.b - color.b)};
    if (fits(mixed)) return mixed;
  }
  return theme.ink;
}

void applyTheme(LayerContent& content, const SceneTheme& theme) {
  if (theme == SceneTheme{}) return;
  for (const auto& prop : content.props) {
    if (auto* actor = vtkActor::SafeDownCast(prop); actor && isDrawing(actor)) {
      const double* was = actor->GetProperty()->GetColor();
      const Rgb color = readable({was[0], was[1], was[2]}, theme);
      actor->GetProperty()->SetColor(color.r, color.g, color.b);
    } else if (vtkTextProperty* letters = lettersOf(prop); letters && !isPlate(prop)) {
      const double* was = letters->GetColor();
      const Rgb color = readable({was[0], was[1], was[2]}, theme);
      letters->SetColor(color.r, color.g, color.b);
    }
  }
  using Mark = LegendEntry::Mark;
  for (LegendEntry& entry : content.legend) {
    if (entry.mark == Mark::Line || entry.mark == Mark::Dashed || entry.mark == Mark::Dot ||
        entry.mark == Mark::Cross)
      entry.color = readable(entry.color, theme);
  }
}

ClipPlanes::ClipPlanes() : planes_(vtkSmartPointer<vtkPlaneCollection>::New()) {
  for (int side = 0; side < 6; ++side) {
    vtkNew<vtkPlane> plane;
    const Eigen::Vector3d inward = (side % 2 ? -1.0 : 1.0) * Eigen::Vector3d::Unit(side / 2);
    plane->SetNormal(inward.x(), inward.y(), inward.z());
    planes_->AddItem(plane);
  }
}

void ClipPlanes::set(const std::optional<Box>& box) {
  box_ = box;
  if (!box) return;
  for (int side = 0; side < 6; ++side) {
    const Eigen::Vector3d& corner = side % 2 ? box->max() : box->min();
    planes_->GetItem(side)->SetOrigin(corner.x(), corner.y(), corner.z());
  }
}

bool isClipped(Layer layer) {
  switch (layer) {
    case Layer::Workspace:
    case Layer::ObjectBox:
    case Layer::Axes:
    case Layer::Candidates:
    case Layer::UtilitySphere:
    case Layer::CoarseRays:
    case Layer::RefinedRays:
    case Layer::RankedViews:
    case Layer::ChosenView:
    case Layer::Path:
    case Layer::Arm:
    case Layer::ArmMotion:
    case Layer::ClearBoxes:
    case Layer::Sensor:
    case Layer::DepthImage:
    case Layer::FilteredDepth:
      return false;
    default:
      return true;
  }
}

PropLooks::PropLooks(const LayerContent& content) {
  for (std::size_t n = 0; n < content.props.size(); ++n) {
    const auto& prop = content.props[n];
    Built& built = props_.emplace_back();
    built.prop = prop;
    built.fine = n + content.fine_props >= content.props.size();
    if (auto* actor = vtkActor::SafeDownCast(prop)) {
      built.opacity = actor->GetProperty()->GetOpacity();
      built.closed = built.opacity == 1.0 && actor->GetProperty()->GetBackfaceCulling();
      built.line_px = actor->GetProperty()->GetLineWidth();
      built.point_px = actor->GetProperty()->GetPointSize();
    } else if (vtkTextProperty* letters = lettersOf(prop)) {
      built.letters_px = letters->GetFontSize();
    }
  }
}

void PropLooks::apply(const LayerLook& look, const ClipPlanes* clip, bool rough) const {
  for (const Built& built : props_) {
    bool visible = look.opacity > 0.0 && !(rough && built.fine);
    if (auto* actor = vtkActor::SafeDownCast(built.prop)) {
      actor->GetProperty()->SetOpacity(built.opacity * look.opacity);
      actor->GetProperty()->SetLineWidth(built.line_px * static_cast<float>(look.size));
      actor->GetProperty()->SetPointSize(built.point_px * static_cast<float>(look.size));
      vtkPlaneCollection* planes = clip ? clip->planes() : nullptr;
      if (built.closed) actor->GetProperty()->SetBackfaceCulling(!planes);
      if (actor->GetMapper() && actor->GetMapper()->GetClippingPlanes() != planes)
        actor->GetMapper()->SetClippingPlanes(planes);
    } else if (vtkTextProperty* letters = lettersOf(built.prop)) {
      letters->SetFontSize(static_cast<int>(std::lround(built.letters_px * look.size)));
      letters->SetOpacity(look.opacity);
      auto* plate = vtkTextActor::SafeDownCast(built.prop);
      if (plate && clip && clip->box()) visible = visible && clip->box()->contains(placeOf(plate));
      if (plate) letters->SetBackgroundOpacity(look.opacity);
    }
    built.prop->SetVisibility(visible);
  }
}

}  // namespace vantage
