// What is shown and how: layers with opacity, size and colour map, slices, clipping box, bookmarks.
#include <imgui.h>

#include <algorithm>
#include <array>

#include "viewer/panels/panel.h"

namespace vantage {
namespace {

struct LayerGroup {
  const char* title;
  std::vector<Layer> layers;
};

const std::vector<LayerGroup>& layerGroups() {
  using L = Layer;
  static const std::vector<LayerGroup> groups = {
      {"Map", {L::Occupied, L::Unknown, L::Free, L::Slices, L::Octree, L::Truth}},
      {"Surface", {L::Surface, L::SegmentLabels, L::Segments, L::SegmentRanks}},
      {"Contours", {L::ContourVoxels, L::ContourPoints, L::SurfaceNormals, L::ContourPoses}},
      {"Views", {L::Candidates, L::UtilitySphere, L::RankedViews, L::ChosenView, L::Path}},
      {"What a view sees", {L::HitVoxels, L::Occluders, L::CoarseRays, L::RefinedRays}},
      {"Sensor", {L::Sensor, L::DepthImage, L::FilteredDepth}},
      {"Frame", {L::Workspace, L::ObjectBox, L::Axes}}};
  return groups;
}

bool hasColorScale(Layer layer) {
  return layer == Layer::Segments || layer == Layer::UtilitySphere || layer == Layer::RankedViews;
}

void colorMap(PanelContext& context, const std::string& name, LayerLook& look) {
  int chosen = !look.color_map ? 0 : *look.color_map == ColorMap::Viridis ? 1 : 2;
  if (!context.widgets.combo(name + "/colour map", "colours", {"own", "viridis", "cividis"}, chosen,
                             ImGui::GetFontSize() * 8.0))
    return;
  look.color_map.reset();
  if (chosen > 0) look.color_map = chosen == 1 ? ColorMap::Viridis : ColorMap::Cividis;
}

void layerDetails(PanelContext& context, Layer layer, const std::string& name) {
  LayerLook& look = context.preferences.view.look(layer);
  const double width = ImGui::GetFontSize() * 8.0;
  ImGui::Indent();
  context.widgets.slider(name + "/opacity", "opacity", look.opacity, 0.0, 1.0, "%.2f", false, width);
  context.widgets.slider(name + "/size", "size", look.size, 0.2, 5.0, "%.1f x", true, width);
  if (hasColorScale(layer)) colorMap(context, name, look);
  ImGui::Unindent();
}

/// The step has nothing for a layer that is on.
bool isEmpty(const PanelContext& context, Layer layer) {
  return context.preferences.view.layers.has(layer) && !context.model.shown().empty() &&
         !context.scene.hasContent(layer);
}

void layerRow(PanelContext& context, Layer layer) {
  const std::string name = "layers/" + std::string(layerName(layer));
  ViewSettings& view = context.preferences.view;
  bool on = view.layers.has(layer);
  const float more = ImGui::GetFrameHeight();
  if (context.widgets.toggle(name, std::string(layerTitle(layer)), on)) view.layers.set(layer, on);
  if (isEmpty(context, layer)) {
    ImGui::SameLine();
    ImGui::TextDisabled("(none)");
    tip("this step has nothing of the kind");
  }
  ImGui::SameLine(ImGui::GetContentRegionMax().x - more);
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID id = ImGui::GetID((name + "/open").c_str());
  const bool open = storage.GetBool(id);
  const bool changed = view.look(layer) != LayerLook{};
  if (context.widgets.button(name + "/more",
                             open      ? "▾"
                             : changed ? "●"
                                       : "▸",
                             true, "opacity, size, colours"))
    storage.SetBool(id, !open);
  if (open) layerDetails(context, layer, name);
}

void styleRows(PanelContext& context) {
  LayerStyle& style = context.preferences.view.style;
  const double width = ImGui::GetFontSize() * 7.0;
  Widgets& w = context.widgets;
  double ranked = style.ranked_views, barred = style.unreachable_views;
  if (w.slider("style/ranked views", "ranked views", ranked, 0, 200, "%.0f", false, width))
    style.ranked_views = static_cast<int>(ranked);
  if (w.slider("style/unreachable views", "unreachable", barred, 0, 200, "%.0f", false, width))
    style.unreachable_views = static_cast<int>(barred);
  w.slider("style/frustum length", "frusta, m", style.frustum_length_m, 0.02, 0.5, "%.2f", false, width);
  w.slider("style/saliency max", "saliency scale", style.saliency_max, 0.05, 1.0, "%.2f", false, width);
  int part = static_cast<int>(style.saliency_part);
  std::vector<std::string> parts;
  for (const std::string_view name : partNames()) parts.emplace_back(name);
  if (w.combo("style/saliency part", "segments by", parts, part, width))
    style.saliency_part = static_cast<SaliencyPart>(part);
  double level = style.octree_level.value_or(-1);
  if (w.slider("style/octree level", "octree level", level, -1, 8, level < 0 ? "start" : "%.0f", false,
               width)) {
    style.octree_level.reset();
    if (level >= 0) style.octree_level = static_cast<int>(level);
  }
  double rays = style.coarse_rays;
  if (w.slider("style/coarse rays", "rays drawn", rays, 10, 5000, "%.0f", true, width))
    style.coarse_rays = static_cast<int>(rays);
  int factor = static_cast<int>(style.utility_factor);
  std::vector<std::string> names;
  for (const std::string_view name : factorNames()) names.emplace_back(name);
  if (w.combo("style/utility factor", "candidates by", names, factor, width))
    style.utility_factor = static_cast<UtilityFactor>(factor);
}

Box workspaceOf(const PanelContext& context) {
  const StepData& shown = context.model.shown();
  if (!shown.empty() && !shown.header->workspace.isEmpty()) return shown.header->workspace;
  return {Eigen::Vector3d(-1, -1, 0), Eigen::Vector3d(1, 1, 1)};
}

/// With the first slice the layer comes, with the last one it goes.
void showSlice(ViewSettings& view, int axis, bool on) {
  auto& slices = view.style.slices;
  if (!view.layers.has(Layer::Slices))
    for (SlicePlane& plane : slices) plane.shown = false;
  slices[axis].shown = on;
  view.layers.set(Layer::Slices, std::ranges::any_of(slices, &SlicePlane::shown));
}

void sliceRows(PanelContext& context) {
  const Box box = workspaceOf(context);
  static constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  ViewSettings& view = context.preferences.view;
  for (int axis = 0; axis < 3; ++axis) {
    SlicePlane& plane = view.style.slices[axis];
    const std::string name = std::string("slices/") + kAxes[axis];
    bool on = plane.shown && view.layers.has(Layer::Slices);
    if (context.widgets.toggle(name, kAxes[axis], on)) showSlice(view, axis, on);
    ImGui::SameLine();
    double at_m = plane.at_m.value_or(box.center()[axis]);
    ImGui::BeginDisabled(!on);
    if (context.widgets.slider(name + "/at", "", at_m, box.min()[axis], box.max()[axis], "%.3f m"))
      plane.at_m = at_m;
    ImGui::EndDisabled();
  }
}

void clipRows(PanelContext& context) {
  static constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  const Box box = workspaceOf(context);
  std::optional<Box>& clip = context.preferences.view.clip;
  bool on = clip.has_value();
  // What lies on a border of the workspace, a table say, is not torn.
  const double margin_m = 0.02 * box.sizes().maxCoeff();
  const Box limits(box.min().array() - margin_m, box.max().array() + margin_m);
  if (context.widgets.toggle("clip/on", "show only a box", on)) {
    clip.reset();
    if (on) clip = limits;
  }
  if (!clip) return;
  const double half = (ImGui::GetContentRegionAvail().x - ImGui::GetFontSize() * 2.0) / 2.0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = std::string("clip/") + kAxes[axis];
    double low = clip->min()[axis], high = clip->max()[axis];
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(kAxes[axis]);
    ImGui::SameLine();
    const bool moved_low = context.widgets.slider(name + " from", "", low, limits.min()[axis],
                                                  limits.max()[axis], "%.2f m", false, half);
    ImGui::SameLine();
    const bool moved_high = context.widgets.slider(name + " to", "", high, limits.min()[axis],
                                                   limits.max()[axis], "%.2f m", false, half);
    if (moved_low) clip->min()[axis] = std::min(low, clip->max()[axis]);
    if (moved_high) clip->max()[axis] = std::max(high, clip->min()[axis]);
  }
}

void bookmarkRows(PanelContext& context) {
  const Command* keep = context.commands.find("view.bookmark");
  if (context.widgets.button("bookmarks/keep", "keep this camera", true, textOf(keep->keys))) keep->run();
  auto& bookmarks = context.preferences.bookmarks;
  std::optional<std::size_t> gone;
  for (std::size_t i = 0; i < bookmarks.size(); ++i) {
    const std::string name = "bookmarks/" + std::to_string(i + 1);
    if (context.widgets.button(name + "/go", std::to_string(i + 1), true, "look from here"))
      context.look_from(bookmarks[i].eye);
    ImGui::SameLine();
    const double room = ImGui::GetContentRegionAvail().x - ImGui::GetFontSize() * 4.6;
    context.widgets.field(name + "/name", bookmarks[i].name, std::max(40.0, room));
    ImGui::SameLine();
    if (context.widgets.button(name + "/forget", "forget")) gone = i;
  }
  if (gone) bookmarks.erase(bookmarks.begin() + static_cast<std::ptrdiff_t>(*gone));
}

}  // namespace

void layersPanel(PanelContext& context) {
  for (const LayerGroup& group : layerGroups()) {
    const bool open = ImGui::CollapsingHeader(group.title, ImGuiTreeNodeFlags_DefaultOpen);
    context.widgets.note("layers/group " + std::string(group.title));
    if (!open) continue;
    for (const Layer layer : group.layers) layerRow(context, layer);
  }
  if (ImGui::CollapsingHeader("Slices", ImGuiTreeNodeFlags_DefaultOpen)) sliceRows(context);
  if (ImGui::CollapsingHeader("Clipping box", ImGuiTreeNodeFlags_DefaultOpen)) clipRows(context);
  if (ImGui::CollapsingHeader("Camera bookmarks", ImGuiTreeNodeFlags_DefaultOpen)) bookmarkRows(context);
  const bool style = ImGui::CollapsingHeader("How much is drawn");
  context.widgets.note("layers/group style");
  if (style) styleRows(context);
}

}  // namespace vantage
