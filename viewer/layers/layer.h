#pragma once

#include <vtkProp.h>
#include <vtkSmartPointer.h>

#include <optional>
#include <string>
#include <vector>

#include "viewer/color.h"
#include "viewer/image.h"
#include "viewer/scene_frame.h"
#include "viewer/view_settings.h"

namespace vantage {

/// What a colour or mark stands for.
struct LegendEntry {
  enum class Mark { Fill, Line, Dashed, Dot, Cross };
  Mark mark = Mark::Fill;
  Rgb color;
  double opacity = 1.0;
  std::string text;
};

/// A colour scale with its unit.
struct ColorScale {
  ColorMap map = ColorMap::Viridis;
  std::string title;  ///< quantity and unit
  double low = 0.0, high = 1.0;
  bool open_top = false;  ///< values above the upper end have its colour
};

/// A picture beside the scene.
struct Inset {
  std::string title;
  RgbImage image;
  ColorScale scale;
};

/// What a layer adds to a view.
struct LayerContent {
  std::vector<vtkSmartPointer<vtkProp>> props;
  std::vector<LegendEntry> legend;
  std::optional<ColorScale> scale;
  std::optional<Inset> inset;
};

// One function a product: it turns the product into actors and nothing more. A product that the record lacks
// gives nothing.
LayerContent workspaceLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent axesLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent truthLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent occupiedLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent unknownLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent freeLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent slicesLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent surfaceLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent segmentsLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent segmentRanksLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent contourVoxelsLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent contourPointsLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent candidatesLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent rankedViewsLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent chosenViewLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent pathLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent sensorLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent depthImageLayer(const SceneFrame& frame, const LayerStyle& style);

/// The content of any layer.
LayerContent buildLayer(Layer layer, const SceneFrame& frame, const LayerStyle& style);

}  // namespace vantage
