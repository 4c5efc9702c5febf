#include "viewer/stage_views.h"

namespace vantage {
namespace {

LayerSet with(std::initializer_list<Layer> layers) {
  LayerSet set(layers);
  set.set(Layer::Workspace, true);
  set.set(Layer::Axes, true);
  return set;
}

std::vector<StageView> contourStages(bool segments) {
  std::vector<StageView> stages = {
      {"scan", "Scan", "the last depth image and where it was taken",
       with({Layer::Truth, Layer::Sensor, Layer::DepthImage})},
      {"fused", "Fused", "the map after fusion: occupied voxels and the frontier of unknown space",
       with({Layer::Occupied, Layer::Unknown})},
      {"contours", "Contours", "free voxels beside surface and unknown, and contour points with normals",
       with({Layer::Surface, Layer::ContourVoxels, Layer::ContourPoints})},
      {"surface", "Surface", "the fused surface, the planner's point cloud", with({Layer::Surface})}};
  if (segments) {
    stages.push_back({"segments", "Segments", "LCCP segments, numbered in the order in which they are tried",
                      with({Layer::Segments, Layer::SegmentRanks})});
    stages.push_back({"saliency", "Saliency", "segments coloured by saliency, and the frontier near them",
                      with({Layer::Segments, Layer::SegmentRanks, Layer::Unknown})});
  }
  stages.push_back({"views", "Views", "the positions of all candidate views",
                    with({Layer::Surface, Layer::ContourPoints, Layer::Candidates})});
  stages.push_back({"scores", "Scores", "the best views of the segment that was tried",
                    with({Layer::Surface, Layer::Unknown, Layer::RankedViews})});
  stages.push_back({"path", "Path", "the chosen view and the way to it",
                    with({Layer::Surface, Layer::RankedViews, Layer::ChosenView, Layer::Path})});
  return stages;
}

std::vector<StageView> octreeStages() {
  return {{"scan", "Scan", "the last depth image and where it was taken",
           with({Layer::Truth, Layer::Sensor, Layer::DepthImage})},
          {"fused", "Fused", "the map after fusion: occupied voxels and the frontier of unknown space",
           with({Layer::Occupied, Layer::Unknown})},
          {"octree", "Octree", "occupied and unknown nodes where tracing starts",
           with({Layer::ObjectBox, Layer::Octree})},
          {"views", "Views", "the positions of all candidate views",
           with({Layer::ObjectBox, Layer::Occupied, Layer::Candidates})},
          {"rays", "Rays", "coarse and refined rays of a view, and what they hit",
           with({Layer::ObjectBox, Layer::HitVoxels, Layer::CoarseRays, Layer::RefinedRays})},
          {"scores", "Scores", "all candidates by utility, and why the others fell out",
           with({Layer::ObjectBox, Layer::Occupied, Layer::UtilitySphere})},
          {"path", "Path", "the chosen view and the way to it",
           with({Layer::ObjectBox, Layer::Occupied, Layer::RankedViews, Layer::ChosenView, Layer::Path})}};
}

}  // namespace

const std::vector<StageView>& stageViews(PlannerKind planner) {
  static const std::vector<StageView> contour = contourStages(true), standard = contourStages(false),
                                      octree = octreeStages();
  if (usesOctree(planner)) return octree;
  return planner == PlannerKind::Contour ? contour : standard;
}

LayerSet overviewLayers(PlannerKind planner) {
  if (usesOctree(planner))
    return with({Layer::ObjectBox, Layer::Occupied, Layer::Unknown, Layer::RankedViews, Layer::ChosenView,
                 Layer::Path});
  return with({Layer::Segments, Layer::SegmentRanks, Layer::Unknown, Layer::RankedViews, Layer::ChosenView,
               Layer::Path});
}

}  // namespace vantage
