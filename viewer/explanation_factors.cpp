// The factors of a view beside those of the view that it is measured against.
#include <algorithm>
#include <functional>

#include "viewer/captions.h"
#include "viewer/explanation_parts.h"
#include "viewer/view_words.h"

namespace vantage {
namespace {

std::string withUnit(double value, const std::string& unit) {
  return whole(value) + " " + unit;
}

/// Bars of one kind, from 0 to the largest value that is drawn.
struct Bar {
  std::string name, about;
  std::function<std::optional<double>(const CandidateRow&)> value;
  std::function<std::string(const CandidateRow&, double value)> text;
  double scale = 0.0;  ///< the bar's end at least, 0 = by the values alone
  std::optional<double> limit = {};
  std::string limit_text = {};
};

ViewFactor drawn(const ExplainedView& view, const Bar& bar) {
  ViewFactor factor{.name = bar.name, .about = bar.about, .limit = bar.limit_text};
  const auto valueOf = [&](const CandidateRow* row) { return row ? bar.value(*row) : std::nullopt; };
  const std::optional<double> mine = valueOf(view.row), theirs = valueOf(view.other);
  const double end = std::max({bar.scale, mine.value_or(0.0), theirs.value_or(0.0), bar.limit.value_or(0.0)});
  const auto reading = [&](const CandidateRow* row, std::optional<double> value) {
    std::optional<FactorReading> result;
    if (value)
      result = {*value, bar.text(*row, *value), end > 0.0 ? std::clamp(*value / end, 0.0, 1.0) : 0.0};
    return result;
  };
  factor.view = reading(view.row, mine);
  factor.other = reading(view.other, theirs);
  if (bar.limit && end > 0.0) factor.limit_share = *bar.limit / end;
  return factor;
}

ViewFactor fact(const ExplainedView& view, std::string name, std::string about,
                const std::function<std::optional<FactorReading>(const CandidateRow&)>& read) {
  ViewFactor factor{.name = std::move(name), .about = std::move(about)};
  if (view.row) factor.view = read(*view.row);
  if (view.other) factor.other = read(*view.other);
  return factor;
}

ViewFactor distance(const ExplainedView& view) {
  return fact(view, "away", "Straight distance from where the sensor is", [](const CandidateRow& r) {
    return FactorReading{r.distance_m, lengthText(r.distance_m), {}};
  });
}

ViewFactor rank(const ExplainedView& view) {
  return fact(view, "rank", "Place in the order in which the views are tried",
              [](const CandidateRow& r) -> std::optional<FactorReading> {
                if (!r.rank) return std::nullopt;
                return FactorReading{static_cast<double>(*r.rank), std::to_string(*r.rank), {}};
              });
}

/// Segment of a row; null for contour points without one.
const Segment* segmentOf(const StepRecord& record, const CandidateRow& row) {
  const std::int32_t index = record.search->segments[row.group].segment;
  if (index < 0 || !record.saliency || static_cast<std::size_t>(index) >= record.saliency->segments.size())
    return nullptr;
  return &record.saliency->segments[index];
}

std::string roundnessText(const Segment& s) {
  return fixed(s.roundness) + " (" + lengthText(s.extent_m[2]) + " / " + lengthText(s.extent_m[0]) + ")";
}

/// What is known of a segment is known before its views are scored.
void addSegmentFactors(ExplainedView view, std::vector<ViewFactor>& factors) {
  const StepRecord& record = view.frame.record;
  const CandidateRow unscored{.group = view.group.value_or(0), .verdict = ViewVerdict::Pending};
  if (!view.row && view.group) view.row = &unscored;
  const auto ofSegment = [&](auto value) {
    return [&record, value](const CandidateRow& row) -> std::optional<double> {
      const Segment* segment = segmentOf(record, row);
      return segment ? std::optional<double>(value(*segment)) : std::nullopt;
    };
  };
  const auto twoDecimals = [](const CandidateRow&, double value) { return fixed(value); };
  double most = 0.0;
  for (const SegmentSearch& group : record.search->segments) most = std::max(most, group.saliency);
  factors.push_back(drawn(view, {"saliency",
                                 "Of its segment: isolation × roundness (eq. 12). The bar ends at the "
                                 "most salient segment with contour points.",
                                 ofSegment([](const Segment& s) { return s.saliency; }), twoDecimals, most}));
  factors.push_back(drawn(view, {"isolation F",
                                 "Share of the segment's points that keep the distance B_th from all others "
                                 "(eq. 11)",
                                 ofSegment([](const Segment& s) { return s.isolation; }), twoDecimals, 1.0}));
  factors.push_back(drawn(
      view, {"roundness", "d_min / d_max: smallest extent of the segment by its largest",
             ofSegment([](const Segment& s) { return s.roundness; }),
             [&](const CandidateRow& row, double) { return roundnessText(*segmentOf(record, row)); }, 1.0}));
  const std::string of = " of " + std::to_string(record.search->segments.size());
  factors.push_back(fact(view, "segment", "Label of its segment, and its place in the order of saliency",
                         [&](const CandidateRow& row) {
                           return FactorReading{row.group + 1.0,
                                                segmentName(view.frame, row.group) + ", no. " +
                                                    std::to_string(row.group + 1) + of,
                                                {}};
                         }));
}

/// Place among the scores of its segment.
ViewFactor rankInSegment(const ExplainedView& view) {
  const auto& groups = view.frame.record.search->segments;
  return fact(view, "in its segment", "Place among the views of its segment by gain",
              [&](const CandidateRow& row) -> std::optional<FactorReading> {
                const auto& scores = groups[row.group].scores;
                const auto at = std::ranges::find(scores, row.id, &PoseScore::id);
                const auto place = static_cast<std::size_t>(at - scores.begin()) + 1;
                return FactorReading{
                    static_cast<double>(place), std::to_string(place) + " of " + grouped(scores.size()), {}};
              });
}

const char* gainText(GainMeasure count) {
  switch (count) {
    case GainMeasure::Rays:
      return "Rays at full resolution that end on unknown inside the region of its segment";
    case GainMeasure::Voxels:
      return "Unknown voxels inside the region of its segment on which rays end";
    case GainMeasure::Volume:
      return "Unknown voxels inside the region of its segment before anything occupied";
  }
  return "";
}

}  // namespace

std::vector<ViewFactor> contourFactors(const ExplainedView& view) {
  const GainConfig& config = view.frame.header.contour_config.gain;
  const std::string unit = countUnit(view.frame);
  std::vector<ViewFactor> factors;
  factors.push_back(
      drawn(view, {.name = "gain",
                   .about = gainText(config.count),
                   .value = [](const CandidateRow& r) { return std::optional(r.score); },
                   .text = [unit](const CandidateRow&, double value) { return withUnit(value, unit); },
                   .limit = config.gain_threshold,
                   .limit_text = "must be more than " + withUnit(config.gain_threshold, unit)}));
  if (plannerOf(view.frame) != "standard") addSegmentFactors(view, factors);
  factors.push_back(rankInSegment(view));
  factors.push_back(rank(view));
  factors.push_back(distance(view));
  return factors;
}

std::vector<ViewFactor> utilityFactors(const ExplainedView& view) {
  const auto& octree = view.frame.header.octree;
  const HierarchicalPlannerConfig config = octree ? octree->planner : HierarchicalPlannerConfig();
  const std::string unit = countUnit(view.frame);
  const auto counted = [&](const CandidateRow&, double value) { return withUnit(value, unit); };
  const auto factorText = [](const CandidateRow&, double value) { return rounded(value, 3); };
  // The cascade ends at the first test that fails: what comes after it was never computed.
  const auto survivor = [](double CandidateRow::*member) {
    return [member](const CandidateRow& r) { return r.survived() ? std::optional(r.*member) : std::nullopt; };
  };
  const auto seen = [](double CandidateRow::*member) {
    return [member](const CandidateRow& r) { return r.cast() ? std::optional(r.*member) : std::nullopt; };
  };
  Bar occupied{"known surface",
               "Counted on occupied voxels of the object's box: enough to register the scan (eq. 2)",
               seen(&CandidateRow::occupied), counted};
  if (config.min_overlap <= 0.0) {
    occupied.limit = config.min_occupied;
    occupied.limit_text = "at least " + withUnit(config.min_occupied, unit) + " (h_oc)";
  } else {
    occupied.limit_text = "at least " + fixed(config.min_overlap) + " of all that it sees";
  }
  std::vector<ViewFactor> factors;
  factors.push_back(drawn(view, {"utility", "Surface factor × distance factor (eq. 1)",
                                 survivor(&CandidateRow::score), factorText}));
  factors.push_back(
      drawn(view, {"surface factor", "Seen unknown per unknown voxel of the object's box (eq. 3)",
                   survivor(&CandidateRow::surface), factorText}));
  factors.push_back(drawn(view, {"distance factor", "1 where the sensor is, less the farther the way (eq. 5)",
                                 survivor(&CandidateRow::distance_factor), factorText, 1.0}));
  factors.push_back(drawn(view, {"unknown", "Counted on unknown voxels of the object's box",
                                 seen(&CandidateRow::unknown), counted, 0.0, config.stop_gain,
                                 "stops below " + withUnit(config.stop_gain, unit) + " (h_stop)"}));
  factors.push_back(drawn(view, occupied));
  factors.push_back(fact(view, "position",
                         "The robot's cube is free there, and the sensor does not stand in something",
                         [](const CandidateRow& r) -> std::optional<FactorReading> {
                           if (r.verdict == ViewVerdict::TakenBefore) return std::nullopt;
                           const bool free = r.verdict != ViewVerdict::NotFree;
                           return FactorReading{free ? 1.0 : 0.0, free ? "free" : "not free", {}};
                         }));
  factors.push_back(rank(view));
  factors.push_back(distance(view));
  return factors;
}

}  // namespace vantage
