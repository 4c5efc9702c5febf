#pragma once

#include <vtkPlaneCollection.h>
#include <vtkProp.h>
#include <vtkSmartPointer.h>

#include <optional>
#include <vector>

#include "viewer/layers/layer.h"
#include "viewer/theme.h"
#include "viewer/view_settings.h"

namespace vantage {

/// Makes lines, dots and letters of a layer and their legend entries readable on a background.
void applyTheme(LayerContent& content, const SceneTheme& theme);

/// Six planes that keep what is inside a box, to be shared by mappers; moving the box moves the planes.
class ClipPlanes {
 public:
  ClipPlanes();
  void set(const std::optional<Box>& box);
  /// Null without a box.
  vtkPlaneCollection* planes() const { return box_ ? planes_.Get() : nullptr; }
  const std::optional<Box>& box() const { return box_; }

 private:
  std::optional<Box> box_;
  vtkSmartPointer<vtkPlaneCollection> planes_;
};

/// True for layers that fill space; the others are never clipped.
bool isClipped(Layer layer);

/// Adjusts the props of a layer without building it again.
class PropLooks {
 public:
  PropLooks() = default;
  /// Remembers opacities and sizes as they were built.
  explicit PropLooks(const LayerContent& content);
  /// \param rough without what rough pictures leave out
  void apply(const LayerLook& look, const ClipPlanes* clip, bool rough) const;

 private:
  struct Built {
    vtkSmartPointer<vtkProp> prop;
    double opacity = 1.0;
    float line_px = 1.0f, point_px = 1.0f;
    int letters_px = 0;
    bool closed = false;  ///< drawn without its inside, which is seen only where it is cut open
    bool fine = false;    ///< not in rough pictures
  };
  std::vector<Built> props_;
};

}  // namespace vantage
