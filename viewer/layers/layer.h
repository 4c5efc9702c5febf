#pragma once

#include <vtkProp.h>
#include <vtkSmartPointer.h>

#include <vector>

#include "viewer/layers/layer_notes.h"
#include "viewer/scene_frame.h"
#include "viewer/view_settings.h"

namespace vantage {

/// What a layer adds to a view.
struct LayerContent : LayerNotes {
  std::vector<vtkSmartPointer<vtkProp>> props;
  std::size_t fine_props = 0;             ///< as many of the last ones are left out of rough pictures
  std::vector<Eigen::Vector3d> must_see;  ///< world points that must not fall outside the picture
};

// One function a product: it turns the product into actors and nothing more. A product that the record lacks
// gives nothing.
LayerContent workspaceLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent objectBoxLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent axesLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent truthLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent occupiedLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent unknownLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent freeLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent slicesLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent octreeLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent surfaceLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent segmentLabelsLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent segmentsLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent segmentRanksLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent contourVoxelsLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent contourPointsLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent surfaceNormalsLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent contourPosesLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent candidatesLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent utilitySphereLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent hitVoxelsLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent contourHitsLayer(const SceneFrame& frame, const LayerStyle& style);  // HitVoxels off the octree
LayerContent occludersLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent coarseRaysLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent refinedRaysLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent rankedViewsLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent chosenViewLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent pathLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent armLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent armMotionLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent clearBoxesLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent sensorLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent depthImageLayer(const SceneFrame& frame, const LayerStyle& style);
LayerContent filteredDepthLayer(const SceneFrame& frame, const LayerStyle& style);

/// The content of any layer. \throws std::invalid_argument for a style that asks for what the step doesn't
/// have.
LayerContent buildLayer(Layer layer, const SceneFrame& frame, const LayerStyle& style);

}  // namespace vantage
