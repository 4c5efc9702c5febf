#include "viewer/layers/layer.h"

#include <array>

namespace vantage {

LayerContent buildLayer(Layer layer, const SceneFrame& frame, const LayerStyle& style) {
  using Build = LayerContent (*)(const SceneFrame&, const LayerStyle&);
  static constexpr std::array<Build, kLayerCount> kBuild = {
      workspaceLayer,     axesLayer,          truthLayer,      occupiedLayer,    unknownLayer,
      freeLayer,          slicesLayer,        surfaceLayer,    segmentsLayer,    segmentRanksLayer,
      contourVoxelsLayer, contourPointsLayer, candidatesLayer, rankedViewsLayer, chosenViewLayer,
      pathLayer,          sensorLayer,        depthImageLayer};
  return kBuild[static_cast<std::size_t>(layer)](frame, style);
}

}  // namespace vantage
