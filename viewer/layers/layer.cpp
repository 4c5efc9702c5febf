#include "viewer/layers/layer.h"

#include <array>

namespace vantage {

LayerContent buildLayer(Layer layer, const SceneFrame& frame, const LayerStyle& style) {
  using Build = LayerContent (*)(const SceneFrame&, const LayerStyle&);
  static constexpr std::array<Build, kLayerCount> kBuild = {
      workspaceLayer,      objectBoxLayer,    axesLayer,         truthLayer,         occupiedLayer,
      unknownLayer,        freeLayer,         slicesLayer,       octreeLayer,        surfaceLayer,
      segmentLabelsLayer,  segmentsLayer,     segmentRanksLayer, contourVoxelsLayer, contourPointsLayer,
      surfaceNormalsLayer, contourPosesLayer, candidatesLayer,   utilitySphereLayer, hitVoxelsLayer,
      occludersLayer,      coarseRaysLayer,   refinedRaysLayer,  rankedViewsLayer,   chosenViewLayer,
      pathLayer,           armLayer,          armMotionLayer,    clearBoxesLayer,    sensorLayer,
      depthImageLayer,     filteredDepthLayer};
  return kBuild[static_cast<std::size_t>(layer)](frame, style);
}

}  // namespace vantage
