#include "viewer/app/experiments/b2_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/gpu/egl_context.h"
#include "snapshots/recipe.h"
#include "viewer/app/experiments/b2_first_step.h"
#include "viewer/captions.h"
#include "viewer/offscreen_renderer.h"
#include "viewer/segment_scores.h"

namespace vantage::experiments {
namespace {

constexpr int kWidth = 1120, kHeight = 700;
constexpr const char* kParts = "Saliency of the segments and its two factors (as in Fig. 9)";
constexpr const char* kDistances = "Saliency under other isolation distances B_th (as in Fig. 10)";

/// What a picture shows.
struct Shown {
  const char* figure;
  std::string name, title;
  SaliencyPart part = SaliencyPart::Whole;
  std::optional<double> isolation_distance_m = {};
};

std::vector<Shown> shownPictures() {
  std::vector<Shown> all = {
      {kParts, "b2_saliency", "Saliency as it is"},
      {kParts, "b2_saliency_roundness", "Saliency by roundness only", SaliencyPart::Roundness},
      {kParts, "b2_saliency_isolation", "Saliency by isolation only", SaliencyPart::Isolation}};
  for (const double b_th_m : {0.005, 0.01, 0.02, 0.05, 0.1})
    all.push_back({kDistances, fmt::format("b2_saliency_b_th_{:g}", b_th_m),
                   fmt::format("Saliency with B_th {:g} m", b_th_m), SaliencyPart::Whole, b_th_m});
  return all;
}

SceneFrame frameOf(const FirstStep& first) {
  return {first.header, *first.record, first.states};
}

/// With the saliency that a style asks for.
std::vector<SegmentRow> rowsUnder(const FirstStep& first, const LayerStyle& style) {
  const std::vector<Segment> segments = shownSegments(frameOf(first), style);
  std::vector<SegmentRow> rows = first.rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::int32_t segment = first.record->search->segments[i].segment;
    rows[i].saliency = segment < 0 ? 0.0 : segments[static_cast<std::size_t>(segment)].saliency;
  }
  return rows;
}

std::string captionOf(const FirstStep& first, const Shown& shown, const LayerStyle& style) {
  const SaliencyEnds ends = saliencyEnds(rowsUnder(first, style));
  const double b_th_m =
      shown.isolation_distance_m.value_or(first.header.contour_config.saliency.isolation_distance_m);
  const char* formula = shown.part == SaliencyPart::Roundness   ? "d_min / d_max"
                        : shown.part == SaliencyPart::Isolation ? "F"
                                                                : "F d_min / d_max";
  const std::string distance =
      shown.part == SaliencyPart::Roundness ? "" : fmt::format(", B_th {}", lengthText(b_th_m));
  return fmt::format("{}{}. Most salient segment that is no object: {:.3f}; least salient object: {:.3f}.",
                     formula, distance, ends.other, ends.object);
}

/// The recipe for segments, nearer to the objects.
ViewSettings viewOf(const Shown& shown) {
  ViewSettings view = recipeNamed("segments").view;
  view.layers.set(Layer::Workspace, false);
  view.layers.set(Layer::Axes, false);
  view.style.saliency_max = 1.0;
  view.style.saliency_part = shown.part;
  view.style.isolation_distance_m = shown.isolation_distance_m;
  view.camera.zoom = 1.9;
  view.camera.front_m = 0.0;
  view.camera.height_share = 0.6;
  return view;
}

std::vector<Picture> takePictures(const FirstStep& first, const RunControl& control) {
  EglContext context;
  OffscreenRenderer renderer(context);
  Scene scene;
  scene.setFrame(frameOf(first));
  std::vector<Picture> pictures;
  for (const Shown& shown : shownPictures()) {
    control.check();
    const ViewSettings view = viewOf(shown);
    const std::string caption = captionOf(first, shown, view.style);
    scene.show(view, {shown.title, stepLine(frameOf(first)), caption}, PageStyle::Full, kWidth, kHeight);
    pictures.push_back({shown.name, shown.figure, shown.title, caption,
                        pngBytes(renderer.render(scene.renderers(), kWidth, kHeight))});
  }
  return pictures;
}

}  // namespace

void addSaliencyPictures(const FirstStep& first, const RunControl& control, Report& report) {
  try {
    std::vector<Picture> pictures = takePictures(first, control);
    std::ranges::move(pictures, std::back_inserter(report.pictures));
  } catch (const Cancelled&) {
    throw;
  } catch (const std::exception& error) {  // the tables are worth more than the pictures
    report.notes.push_back(std::string("B2: the pictures of saliency are left out: ") + error.what());
  }
}

}  // namespace vantage::experiments
