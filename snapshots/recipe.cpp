#include "snapshots/recipe.h"

#include <algorithm>

#include "io/error.h"
#include "io/suggest.h"
#include "viewer/captions.h"

namespace vantage {
namespace {

ViewSettings viewOf(LayerSet layers) {
  ViewSettings view;
  view.layers = layers;
  view.layers.set(Layer::Workspace, true);
  view.layers.set(Layer::ObjectBox, true);
  view.layers.set(Layer::Axes, true);
  return view;
}

/// Near the segment that was tried.
ViewSettings nearSegment(LayerSet layers) {
  ViewSettings view;
  view.layers = layers;
  view.camera.focus = CameraFocus::Segment;
  return view;
}

/// Segments coloured by one factor of their saliency.
ViewSettings byPart(SaliencyPart part) {
  ViewSettings view = viewOf({Layer::Segments, Layer::SegmentRanks});
  view.style.saliency_part = part;
  view.style.saliency_max = 1.0;
  return view;
}

/// How the contour planner comes to its view, stage by stage.
void addContourDetails(std::vector<Recipe>& all) {
  ViewSettings normals =
      nearSegment({Layer::Surface, Layer::ContourVoxels, Layer::ContourPoints, Layer::SurfaceNormals});
  normals.camera.azimuth_rad = -0.26;  // along the far border of what was scanned from -y
  normals.camera.zoom = 1.8;
  ViewSettings poses = nearSegment({Layer::Surface, Layer::ContourVoxels, Layer::ContourPoses});
  poses.style.frustum_length_m = 0.09;
  poses.style.surface_opacity = 0.4;  // the frusta stand before it
  all.push_back({"normals", "Frontier normals and surface normals",
                 "near the segment that was tried: where views come from by either normal", normals,
                 normalFigures});
  all.push_back({"poses", "View poses of a contour point",
                 "all poses of the contour point that the chosen view looks at", poses, poseFigures});
  all.push_back({"labels", "Segments",
                 "the segments, a colour for each, in the order in which they are tried",
                 viewOf({Layer::SegmentLabels, Layer::SegmentRanks}), segmentFigures});
  all.push_back({"roundness", "Roundness of the segments", "segments coloured by d_min / d_max alone",
                 byPart(SaliencyPart::Roundness), segmentFigures});
  all.push_back({"isolation", "Isolation of the segments", "segments coloured by F alone",
                 byPart(SaliencyPart::Isolation), segmentFigures});
  all.push_back({"counted", "What the next best view counts",
                 "the chosen view, the unknown that it counts and the sphere in which it does",
                 nearSegment({Layer::Surface, Layer::HitVoxels, Layer::ChosenView}), viewFigures});
}

std::vector<Recipe> makeRecipes() {
  std::vector<Recipe> all;
  all.push_back({"scene", "Scene and sensor", "the true scene, the sensor and its last depth image",
                 viewOf({Layer::Truth, Layer::Arm, Layer::Sensor, Layer::DepthImage}), scanFigures});
  all.push_back({"filters", "Depth filters", "what the depth filters removed of the last image",
                 viewOf({Layer::Truth, Layer::Sensor, Layer::FilteredDepth}), filterFigures});
  all.push_back({"states", "Voxel states", "what is occupied and what is still unknown",
                 viewOf({Layer::Occupied, Layer::Unknown}), stateFigures});
  all.push_back({"contours", "Contours", "contour voxels and contour points with their normals",
                 viewOf({Layer::Surface, Layer::ContourVoxels, Layer::ContourPoints}), contourFigures});
  all.push_back({"segments", "Saliency of the segments",
                 "the surface coloured by the saliency of its segments",
                 viewOf({Layer::Segments, Layer::SegmentRanks}), segmentFigures});
  all.push_back({"views", "Ranked views and the next best view",
                 "the best views, the chosen one and the path to it",
                 viewOf({Layer::Surface, Layer::Unknown, Layer::RankedViews, Layer::ChosenView, Layer::Path}),
                 viewFigures});
  ViewSettings octree = viewOf({Layer::Octree});
  octree.layers.set(Layer::Workspace, false);
  octree.camera.focus = CameraFocus::Object;
  all.push_back(
      {"octree", "Octree", "occupied and unknown nodes at one depth of the octree", octree, octreeFigures});
  ViewSettings rays = viewOf({Layer::Truth, Layer::HitVoxels, Layer::CoarseRays, Layer::RefinedRays});
  rays.style.truth_opacity = 0.15;
  rays.layers.set(Layer::Workspace, false);
  rays.camera.focus = CameraFocus::Object;
  all.push_back({"rays", "Rays of the next best view", "coarse rays, refined rays and what they hit", rays,
                 rayFigures});
  all.push_back({"utility", "Utility of the candidate views",
                 "all candidates coloured by utility, those that fell out and the chosen one",
                 viewOf({Layer::Occupied, Layer::Unknown, Layer::UtilitySphere, Layer::Path}),
                 utilityFigures});
  all.push_back({"candidates", "Candidate views", "the positions of all candidate views",
                 viewOf({Layer::Surface, Layer::Candidates, Layer::ChosenView}), contourFigures});
  all.push_back({"slice", "Slice through the voxel states",
                 "states on the plane through the middle of the scene",
                 viewOf({Layer::Slices, Layer::Surface}), stateFigures});
  all.push_back({"overview", "What is known, and where to look next",
                 "states, contours, segment and chosen view in one picture",
                 viewOf({Layer::Segments, Layer::SegmentRanks, Layer::Unknown, Layer::ContourVoxels,
                         Layer::ChosenView, Layer::Path}),
                 viewFigures});
  all.push_back({kArmRecipe, "The arm and its way to the next best view",
                 "where the arm stands after the scan, how it moves, and where it arrives",
                 viewOf({Layer::Surface, Layer::RankedViews, Layer::ChosenView, Layer::Path, Layer::Arm,
                         Layer::ArmMotion}),
                 viewFigures});
  addContourDetails(all);
  return all;
}

}  // namespace

bool Recipe::planning() const {
  static constexpr Layer kOfTheMap[] = {
      Layer::Workspace, Layer::ObjectBox, Layer::Axes,   Layer::Truth,      Layer::Occupied,
      Layer::Unknown,   Layer::Free,      Layer::Slices, Layer::Arm,        Layer::ClearBoxes,
      Layer::Octree,    Layer::Surface,   Layer::Sensor, Layer::DepthImage, Layer::FilteredDepth};
  LayerSet rest = view.layers;
  for (const Layer layer : kOfTheMap) rest.set(layer, false);
  return rest != LayerSet();
}

const std::vector<Recipe>& recipes() {
  static const std::vector<Recipe> all = makeRecipes();
  return all;
}

std::vector<std::string> recipeNames() {
  std::vector<std::string> names;
  for (const Recipe& recipe : recipes()) names.push_back(recipe.name);
  return names;
}

bool Recipe::fits(PlannerKind planner) const {
  static constexpr Layer kOnTsdf[] = {Layer::Segments,      Layer::SegmentLabels, Layer::SegmentRanks,
                                      Layer::ContourVoxels, Layer::ContourPoints, Layer::SurfaceNormals,
                                      Layer::ContourPoses};
  static constexpr Layer kOnOctree[] = {Layer::Octree, Layer::UtilitySphere, Layer::CoarseRays,
                                        Layer::RefinedRays};
  const auto shows = [&](Layer layer) { return view.layers.has(layer); };
  return usesOctree(planner) ? std::ranges::none_of(kOnTsdf, shows) : std::ranges::none_of(kOnOctree, shows);
}

bool Recipe::showsRays() const {
  static constexpr Layer kOfRays[] = {Layer::HitVoxels, Layer::CoarseRays, Layer::RefinedRays,
                                      Layer::ContourPoses};
  return std::ranges::any_of(kOfRays, [&](Layer layer) { return view.layers.has(layer); });
}

bool Recipe::foreign(PlannerKind planner) const {
  static constexpr Figures* kOnTsdf[] = {contourFigures, segmentFigures, normalFigures, poseFigures};
  static constexpr Figures* kOnOctree[] = {octreeFigures, rayFigures, utilityFigures};
  const auto isCaption = [&](Figures* other) { return figures == other; };
  return !fits(planner) && (usesOctree(planner) ? std::ranges::any_of(kOnTsdf, isCaption)
                                                : std::ranges::any_of(kOnOctree, isCaption));
}

std::vector<std::string> defaultRecipes(PlannerKind planner) {
  if (usesOctree(planner)) return {"scene", "states", "octree", "rays", "utility", "views"};
  return {"scene", "states", "contours", "segments", "views"};
}

std::vector<std::string> defaultRecipesOf(const RunHeader& header) {
  std::vector<std::string> names;
  for (const PlannerKind planner : plannersFromText(header.planner)) {
    for (const std::string& name : defaultRecipes(planner))
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  if (header.arm) names.push_back(kArmRecipe);
  return names;
}

const Recipe& recipeNamed(const std::string& name) {
  const auto found =
      std::find_if(recipes().begin(), recipes().end(), [&](const Recipe& r) { return r.name == name; });
  if (found != recipes().end()) return *found;
  throw InputError("recipe '" + name + "'", "there is no such recipe" + suggestion(name, recipeNames()));
}

ViewSettings viewFor(const Recipe& recipe, const SceneFrame& frame) {
  ViewSettings view = recipe.view;
  if (view.layers.has(Layer::Truth) && (!frame.truth || frame.truth->empty())) {
    view.layers.set(Layer::Truth, false);
    view.layers.set(Layer::Surface, true);
  }
  if (view.layers.has(Layer::Surface) && onOctree(frame) && !frame.record.surface) {
    view.layers.set(Layer::Surface, false);
    view.layers.set(Layer::Occupied, true);
  }
  return view;
}

}  // namespace vantage
