#include "viewer/segment_scores.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "viewer/captions.h"

namespace vantage {
namespace {

SaliencyConfig configFor(const SceneFrame& frame, const LayerStyle& style) {
  SaliencyConfig config = frame.header.contour_config.saliency;
  if (style.isolation_distance_m) config.isolation_distance_m = *style.isolation_distance_m;
  if (style.saliency_part == SaliencyPart::Whole) return config;
  config.use_roundness = style.saliency_part == SaliencyPart::Roundness;
  config.use_isolation = style.saliency_part == SaliencyPart::Isolation;
  return config;
}

}  // namespace

bool asksOtherSaliency(const LayerStyle& style) {
  return style.saliency_part != SaliencyPart::Whole || style.isolation_distance_m;
}

std::vector<Segment> shownSegments(const SceneFrame& frame, const LayerStyle& style) {
  const StepRecord& record = frame.record;
  if (!record.saliency) return {};
  if (!record.labels || !asksOtherSaliency(style)) return record.saliency->segments;
  return rescoreSegments(*record.saliency, *record.labels, configFor(frame, style));
}

std::vector<std::uint32_t> shownOrder(const SceneFrame& frame, const LayerStyle& style) {
  if (!frame.record.search) return {};
  const std::vector<SegmentSearch>& searches = frame.record.search->segments;
  std::vector<std::uint32_t> order(searches.size());
  std::iota(order.begin(), order.end(), 0u);
  if (!asksOtherSaliency(style)) return order;
  const std::vector<Segment> segments = shownSegments(frame, style);
  const auto place = [&](std::uint32_t i) {  // points without a segment come last (D-B13), ties by label
    const std::int32_t segment = searches[i].segment;
    const bool known = segment >= 0 && segment < static_cast<std::int32_t>(segments.size());
    return std::tuple(!known, known ? -segments[static_cast<std::size_t>(segment)].saliency : 0.0, segment);
  };
  std::ranges::stable_sort(order, {}, place);
  return order;
}

std::string saliencyWords(const LayerStyle& style) {
  if (style.saliency_part == SaliencyPart::Roundness) return "roundness d_min / d_max";
  const std::string word = style.saliency_part == SaliencyPart::Isolation ? "isolation F" : "saliency";
  return style.isolation_distance_m ? word + ", B_th = " + lengthText(*style.isolation_distance_m) : word;
}

}  // namespace vantage
