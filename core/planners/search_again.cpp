#include "core/planners/search_again.h"

#include <algorithm>
#include <stdexcept>

#include "core/planners/contour_groups.h"
#include "core/planners/view_selection.h"

namespace vantage {
namespace {

/// Contour points not to be offered again change which points form a group.
bool sameOffer(const GainConfig& a, const GainConfig& b) {
  if (!a.exclude_disappointing && !b.exclude_disappointing) return true;
  return a.exclude_disappointing == b.exclude_disappointing &&
         a.disappointing_share == b.disappointing_share &&
         a.disappointing_distance_m == b.disappointing_distance_m;
}

/// Column of the cumulative histograms for a margin; none if the scores are of that margin as they are.
std::optional<int> columnFor(const ContourPlannerConfig& scored_with, const ContourPlannerConfig& wanted) {
  if (!wanted.segment_by_segment || scored_with.gain.sphere_margin_m == wanted.gain.sphere_margin_m)
    return std::nullopt;
  return marginBins(wanted.gain.sphere_margin_m);
}

/// Running sums over the bins, all casts of a bin side by side.
std::vector<std::uint32_t> accumulated(const std::vector<std::vector<std::uint32_t>>& histograms) {
  const std::size_t casts = histograms.size();
  std::vector<std::uint32_t> within(casts * kHistogramBins);
  for (std::size_t h = 0; h < casts; ++h) {
    std::uint32_t sum = 0;
    for (int k = 0; k < kHistogramBins; ++k) {
      if (static_cast<std::size_t>(k) < histograms[h].size()) sum += histograms[h][k];
      within[k * casts + h] = sum;
    }
  }
  return within;
}

/// Gains in voxels and those of the baseline have none.
bool needsHistograms(const ContourPlannerConfig& config) {
  return config.segment_by_segment && config.gain.count == GainMeasure::Rays;
}

bool hasHistograms(const SegmentSearch& group) {
  return std::ranges::none_of(group.scores, [](const PoseScore& score) { return score.histogram < 0; });
}

void setMargin(const ScoredGroup& kept, int bins, const GainConfig& gain, std::vector<PoseScore>& scores) {
  const std::uint32_t* within = kept.unknown_within.data() + static_cast<std::size_t>(bins) * kept.histograms;
  for (PoseScore& score : scores) {
    score.unknown = within[score.histogram];
    score.gain = score.unknown * gain.perUnknown();
  }
}

}  // namespace

bool canSearchAgain(const GainConfig& scored_with, const GainConfig& wanted, bool segment_by_segment) {
  if (scored_with.reduction != wanted.reduction || scored_with.count != wanted.count ||
      scored_with.outside != wanted.outside || !sameOffer(scored_with, wanted))
    return false;
  if (!segment_by_segment || scored_with.sphere_margin_m == wanted.sphere_margin_m) return true;
  return wanted.count == GainMeasure::Rays && wanted.outside == OutsideUnknown::Opaque &&
         marginBins(wanted.sphere_margin_m).has_value();
}

std::shared_ptr<const ScoredGroup> keepScores(const SegmentSearch& group) {
  const auto kept = std::make_shared<ScoredGroup>();
  kept->segment = group.segment;
  kept->contour_points = group.contour_points;
  kept->scores = group.scores;
  std::ranges::sort(kept->scores, {}, &PoseScore::id);
  for (PoseScore& score : kept->scores) score.reachability = Reachability::NotChecked;
  kept->histograms = static_cast<std::uint32_t>(group.histograms.size());
  kept->unknown_within = accumulated(group.histograms);
  return kept;
}

std::shared_ptr<const ScoredGroup> scoreGroup(const ViewSearchInput& input,
                                              const ContourPlannerConfig& config, const SegmentSearch& group,
                                              const RunControl& control) {
  SegmentSearch scored;
  scored.segment = group.segment;
  scored.contour_points = group.contour_points;
  SearchCounts counts;
  scoreSegment(input, config, scored, counts, control);
  return keepScores(scored);
}

ScoredGroups::ScoredGroups(const ViewSearch& search, const ContourPlannerConfig& scored_with)
    : scored_with_(scored_with) {
  for (const SegmentSearch& group : search.segments)
    if (group.scored && (!needsHistograms(scored_with) || hasHistograms(group))) add(keepScores(group));
}

void ScoredGroups::add(std::shared_ptr<const ScoredGroup> group) {
  of_segment_[group->segment] = std::move(group);
}

const ScoredGroup* ScoredGroups::of(const SegmentSearch& group) const {
  const auto found = of_segment_.find(group.segment);
  if (found == of_segment_.end() || found->second->contour_points != group.contour_points) return nullptr;
  return found->second.get();
}

std::vector<std::uint32_t> ScoredGroups::pendingIn(const ViewSearch& search) const {
  std::vector<std::uint32_t> pending;
  for (std::uint32_t s = 0; s < search.segments.size(); ++s)
    if (!of(search.segments[s])) pending.push_back(s);
  return pending;
}

bool fillScores(const ViewSearchInput& input, const ContourPlannerConfig& wanted, const ScoredGroups& groups,
                SegmentSearch& group) {
  const ScoredGroup* kept = groups.of(group);
  if (!kept) return false;
  group.scores = kept->scores;
  if (const std::optional<int> bins = columnFor(groups.scoredWith(), wanted))
    setMargin(*kept, *bins, wanted.gain, group.scores);
  markExecuted(input, wanted, group.scores);
  rankByGain(group.scores);
  group.scored = true;
  return true;
}

SearchAgain searchAgain(const ViewSearchInput& input, const ContourPlannerConfig& wanted,
                        const ScoredGroups& groups, const ReachPose& reach, const RunControl& control) {
  const ContourPlannerConfig& have = groups.scoredWith();
  if (wanted.segment_by_segment != have.segment_by_segment || !(wanted.views == have.views) ||
      !canSearchAgain(have.gain, wanted.gain, wanted.segment_by_segment))
    throw std::invalid_argument(
        "search again: the scores kept don't answer for the wanted configuration; score the poses afresh");
  const GroupScores kept = [&](SegmentSearch& group, SearchCounts& counts) {
    if (!fillScores(input, wanted, groups, group)) return false;
    counts.poses_scored += group.scores.size();
    counts.poses_above_threshold += static_cast<std::uint64_t>(std::ranges::count_if(
        group.scores, [&](const PoseScore& s) { return s.gain > wanted.gain.gain_threshold; }));
    return true;
  };
  ViewSelection selection = selectView(input, wanted, kept, reach, control);
  return {std::move(selection.search), selection.pending};
}

}  // namespace vantage
