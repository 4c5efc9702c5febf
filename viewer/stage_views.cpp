#include "viewer/stage_views.h"

#include <algorithm>
#include <array>

namespace vantage {
namespace {

LayerSet with(std::initializer_list<Layer> layers) {
  LayerSet set(layers);
  set.set(Layer::Workspace, true);
  set.set(Layer::Axes, true);
  return set;
}

StageView overviewStage(LayerSet layers) {
  return {"overview", "Overview", "a bit of every stage, and the view that was chosen", std::move(layers)};
}

std::vector<StageView> contourStages(bool segments) {
  std::vector<StageView> stages = {
      overviewStage(segments ? with({Layer::Segments, Layer::SegmentRanks, Layer::Unknown, Layer::RankedViews,
                                     Layer::ChosenView, Layer::Path})
                             : with({Layer::Surface, Layer::Unknown, Layer::RankedViews, Layer::ChosenView,
                                     Layer::Path})),
      {"scan", "Scan", "the last depth image and where it was taken",
       with({Layer::Truth, Layer::Arm, Layer::Sensor, Layer::DepthImage})},
      {"fused", "Fused", "the map after fusion: occupied voxels and the frontier of unknown space",
       with({Layer::Occupied, Layer::Unknown})},
      {"contours", "Contours", "free voxels beside surface and unknown, and contour points with normals",
       with({Layer::Surface, Layer::ContourVoxels, Layer::ContourPoints})},
      {"surface", "Surface", "the fused surface, the planner's point cloud", with({Layer::Surface})}};
  if (segments) {
    stages.push_back({"segments", "Segments",
                      "LCCP segments, a colour for each, numbered in the order in which they are tried",
                      with({Layer::SegmentLabels, Layer::SegmentRanks})});
    stages.push_back({"saliency", "Saliency", "segments coloured by saliency, and the frontier near them",
                      with({Layer::Segments, Layer::SegmentRanks, Layer::Unknown})});
  }
  stages.push_back({"views", "Views", "the positions of all candidate views",
                    with({Layer::Surface, Layer::ContourPoints, Layer::Candidates})});
  stages.push_back({"scores", "Scores", "the best views of the segment that was tried",
                    with({Layer::Surface, Layer::Unknown, Layer::RankedViews})});
  stages.push_back({"path", "Path", "the chosen view and the way to it",
                    with({Layer::Surface, Layer::RankedViews, Layer::ChosenView, Layer::Path, Layer::Arm,
                          Layer::ArmMotion})});
  return stages;
}

std::vector<StageView> octreeStages() {
  return {overviewStage(with({Layer::ObjectBox, Layer::Occupied, Layer::Unknown, Layer::RankedViews,
                              Layer::ChosenView, Layer::Path})),
          {"scan", "Scan", "the last depth image and where it was taken",
           with({Layer::Truth, Layer::Arm, Layer::Sensor, Layer::DepthImage})},
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
           with({Layer::ObjectBox, Layer::Occupied, Layer::RankedViews, Layer::ChosenView, Layer::Path,
                 Layer::Arm, Layer::ArmMotion})}};
}

using Stages = std::vector<StageView>;

Stages withOverview(Stages stages, const char* about, const LayerSet& layers) {
  stages.front() = {"overview", "Overview", about, layers};
  return stages;
}

/// With the stage of the depth filters behind the scan.
Stages withFilters(Stages stages) {
  const auto fused = std::ranges::find(stages, "fused", &StageView::name);
  stages.insert(fused,
                {"filtered", "Filtered", "the last depth image: what the filters removed, and which of them",
                 with({Layer::Truth, Layer::Sensor, Layer::FilteredDepth})});
  return stages;
}

/// For each content.
std::array<Stages, 3> stagesOf(Stages planned) {
  return {
      planned, withOverview(planned, "the map after the last scan", with({Layer::Occupied, Layer::Unknown})),
      withOverview(planned, "everything that the file holds",
                   with({Layer::Truth, Layer::Surface, Layer::Occupied, Layer::Unknown, Layer::Candidates}))};
}

}  // namespace

const Stages& stageViews(PlannerKind planner, StepContent content, bool filtered) {
  const auto forAll = [](auto change) {
    return std::array<std::array<Stages, 3>, 3>{stagesOf(change(contourStages(true))),
                                                stagesOf(change(contourStages(false))),
                                                stagesOf(change(octreeStages()))};
  };
  static const auto plain = forAll([](Stages stages) { return stages; }), with_filters = forAll(withFilters);
  const std::size_t kind = usesOctree(planner) ? 2 : planner == PlannerKind::Contour ? 0 : 1;
  return (filtered ? with_filters : plain)[kind][static_cast<std::size_t>(content)];
}

int stageNamed(const Stages& stages, const std::string& name) {
  const auto found = std::ranges::find(stages, name, &StageView::name);
  return found == stages.end() ? 0 : static_cast<int>(found - stages.begin());
}

}  // namespace vantage
