// Pictures beside the scene, over the 3-D view.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "viewer/layers/layer.h"
#include "viewer/panels/overlays.h"
#include "viewer/panels/plot.h"
#include "viewer/ui_host.h"

namespace vantage {
namespace {

constexpr float kLegend_em = 24.0f, kWidth_em = 14.0f, kGap_px = 10.0f;
constexpr float kSmallest_px = 60.0f;  ///< nothing can be seen in less
constexpr double kNear_m = 0.8;        ///< what the eye of the picture turns about, of no matter here

/// Height of a picture of that shape; long ones are cut.
float heightOf(float width, int picture_width, int picture_height) {
  return std::clamp(
      width * static_cast<float>(picture_height) / static_cast<float>(std::max(1, picture_width)), 40.0f,
      2.0f * width);
}

/// A texture that is filled when what it shows changes.
struct Picture {
  UiTexture texture;
  std::uint64_t revision = 0;
  std::uint64_t what = 0;
  int width = 0;
  bool filled = false;

  bool isOf(std::uint64_t wanted_revision, std::uint64_t wanted, int wanted_width) const {
    return filled && revision == wanted_revision && what == wanted && width == wanted_width;
  }
  void set(const RgbImage& image, std::uint64_t of_revision, std::uint64_t of, int of_width) {
    texture.set(image);
    revision = of_revision;
    what = of;
    width = of_width;
    filled = true;
  }
};

/// What stands below a picture.
struct Words {
  std::string title;
  std::vector<LegendEntry> legend;
  std::optional<ColorScale> scale;
};

/// Places insets from the top downward.
class Column {
 public:
  /// \param boxes takes those of what is placed
  Column(PanelContext& context, const ViewArea& area, float width, std::vector<WidgetBox>& boxes)
      : context_(context), area_(area), width_(width), top_(area.top + kGap_px), boxes_(boxes) {}

  float width() const { return width_; }
  /// There is room for a picture of that height and what is written below it.
  bool hasRoom(float height) const { return top_ + height + ImGui::GetFontSize() <= area_.bottom; }

  void add(const std::string& name, const Picture& picture, float height, const Words& words, Rgb border) {
    constexpr float kPad = 5.0f;
    const ImVec2 low{area_.right - kGap_px - width_, top_}, high{area_.right - kGap_px, top_ + height};
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.ChannelsSplit(2);  // how high the plate is shows when all is written on it
    draw.ChannelsSetCurrent(1);
    draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(picture.texture.handle())), low,
                  high);
    ImGui::SetCursorScreenPos({low.x + kPad, high.y + kPad});
    ImGui::BeginGroup();
    wrappedText(words.title, width_ - 2 * kPad);
    if (words.scale) {
      wrappedText(words.scale->title, width_ - 2 * kPad);
      drawColorScale(*words.scale, width_ - 2 * kPad, context_.theme);
    }
    ImGui::EndGroup();
    const ImVec2 end{high.x, ImGui::GetItemRectMax().y + kPad};
    draw.ChannelsSetCurrent(0);
    draw.AddRectFilled(low, end, packed(context_.theme.panel, 0.9));
    draw.ChannelsMerge();
    draw.AddRect(low, end, packed(border), 0.0f, 0, 2.0f);
    boxes_.push_back({low.x, low.y, end.x, end.y, true});
    context_.widgets.note(area_.name + "/" + name, boxes_.back());
    if (ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(low, end)) tellLegend(words.legend);
    top_ = end.y + kGap_px;
  }

 private:
  /// There is no room for it below the picture.
  void tellLegend(const std::vector<LegendEntry>& legend) {
    if (legend.empty()) return;
    ImGui::BeginTooltip();
    for (const LegendEntry& entry : legend)
      drawLegendEntry(entry, context_.theme, kLegend_em * ImGui::GetFontSize());
    ImGui::EndTooltip();
    context_.widgets.note(area_.name + "/inset legend");
  }

  PanelContext& context_;
  ViewArea area_;
  float width_, top_;
  std::vector<WidgetBox>& boxes_;
};

}  // namespace

struct ViewInsets::State {
  Picture view;
  std::array<Picture, 2> layers;  ///< of those that have a picture, in their order
  std::uint64_t of_step = 0;
  std::vector<WidgetBox> boxes;          ///< of the last frame
  std::vector<LegendEntry> view_legend;  ///< of what the view counts and what ends its rays

  void drawView(PanelContext& context, Viewport& viewport, Column& column, double pixel_scale,
                std::uint64_t revision);
  void drawLayers(PanelContext& context, Column& column, std::uint64_t revision);
};

ViewInsets::ViewInsets() : state_(std::make_unique<State>()) {}
ViewInsets::~ViewInsets() = default;

/// The map through the explained view, with what it counts and what ends its rays; through the one before
/// until its picture is there.
void ViewInsets::State::drawView(PanelContext& context, Viewport& viewport, Column& column,
                                 double pixel_scale, std::uint64_t revision) {
  // A picture of another step would be taken for one of this.
  const std::uint64_t before = std::exchange(of_step, context.model.revision());
  if (before != of_step) view.filled = false;
  const auto id = context.model.explainedView();
  if (!context.preferences.show_inset || !id) return;
  const SceneFrame frame = context.model.shown().frame();
  const auto pose = poseOfCandidate(frame, *id);
  if (!pose) return;
  const PinholeCamera camera = viewCamera(frame);
  const float height = heightOf(column.width(), camera.width, camera.height);
  if (!column.hasRoom(height)) return;
  const int width_px = static_cast<int>(std::lround(column.width() * pixel_scale));
  // It takes longer than a rough picture of the scene, and waits with the full one.
  if (viewport.settled() && !view.isOf(revision, *id, width_px)) {
    static const LayerSet kLayers = {Layer::Surface, Layer::Occupied, Layer::HitVoxels, Layer::Occluders};
    vtkRenderer* const renderers[] = {context.scene.inset(eyeOfView(camera, *pose, kNear_m), kLayers)};
    view.set(viewport.picture(renderers, width_px, static_cast<int>(std::lround(height * pixel_scale))),
             revision, *id, width_px);
    view_legend.clear();
    for (const Layer seen : {Layer::HitVoxels, Layer::Occluders})
      if (const LayerContent* content = context.scene.content(seen))
        view_legend.insert(view_legend.end(), content->legend.begin(), content->legend.end());
  }
  if (!view.filled) return;
  column.add("inset", view, height,
             {"view " + std::to_string(view.what) + ": predicted to see", view_legend, {}},
             context.theme.chosen);
}

void ViewInsets::State::drawLayers(PanelContext& context, Column& column, std::uint64_t revision) {
  std::size_t shown = 0;
  for (const LayerNotes* notes : context.scene.shownNotes()) {
    if (!notes->inset || shown == layers.size()) continue;
    const Inset& inset = *notes->inset;
    const float height = heightOf(column.width(), inset.image.width, inset.image.height);
    if (!column.hasRoom(height)) return;
    const std::uint64_t what =
        std::hash<std::string>()(inset.title) ^ static_cast<std::uint64_t>(inset.scale.map);
    Picture& picture = layers[shown];
    if (!picture.isOf(revision, what, inset.image.width))
      picture.set(inset.image, revision, what, inset.image.width);
    const std::string name = shown == 0 ? "depth" : "depth " + std::to_string(shown + 1);
    column.add(name, picture, height, {inset.title, {}, inset.scale}, context.theme.faint);
    ++shown;
  }
}

void ViewInsets::draw(PanelContext& context, Viewport& viewport, const ViewArea& area, float room,
                      double pixel_scale, std::uint64_t revision) {
  state_->boxes.clear();
  const float width = std::min(kWidth_em * ImGui::GetFontSize(), room - 2.0f * kGap_px);
  if (width < kSmallest_px) return;
  Column column(context, area, width, state_->boxes);
  state_->drawView(context, viewport, column, pixel_scale, revision);
  state_->drawLayers(context, column, revision);
}

bool ViewInsets::cover(double x, double y) const {
  return std::ranges::any_of(state_->boxes, [&](const WidgetBox& b) {
    return x >= b.left && x < b.right && y >= b.top && y < b.bottom;
  });
}

}  // namespace vantage
