#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/planners/contour_planner.h"

namespace vantage {

/// True if searchAgain() can answer for `wanted` from scores made with `scored_with`: they differ at most in
/// the threshold, in which executed poses are left out (D-B15), and in the sphere's margin. Another margin
/// needs gains in rays, opaque outside and a whole number of bins, see marginBins(); for the baseline none
/// matters.
bool canSearchAgain(const GainConfig& scored_with, const GainConfig& wanted, bool segment_by_segment = true);

/// The scores of one group of contour points, good for every threshold and margin. Immutable once made, so
/// that one thread makes them and another one ranks them.
struct ScoredGroup {
  std::int32_t segment =
      -1;  ///< index into Saliency::segments; -1 = points without a segment, or the baseline
  std::vector<std::uint32_t> contour_points;
  std::vector<PoseScore> scores;  ///< by ascending id, under the margin that they were made with
  std::uint32_t histograms = 0;   ///< distinct casts
  /// Unknown rays of cast h within a margin of k bins, at [k * histograms + h]; empty for the baseline and
  /// for gains in voxels.
  std::vector<std::uint32_t> unknown_within;
};

/// The group as it was scored by a search. \pre group.scored
std::shared_ptr<const ScoredGroup> keepScores(const SegmentSearch& group);

/// Casts the rays of a group that has no scores yet; `group` is one of a search's segments. May run beside
/// searches on another thread: it only reads. \param config see ScoredGroups::scoredWith()
/// \throws Cancelled
std::shared_ptr<const ScoredGroup> scoreGroup(const ViewSearchInput& input,
                                              const ContourPlannerConfig& config, const SegmentSearch& group,
                                              const RunControl& control);

/// The groups of a step that were scored so far, by segment. Starts with those that a search has reached and
/// grows by scoreGroup(). Copies share the scores.
class ScoredGroups {
 public:
  /// \param search made with `scored_with`
  ScoredGroups(const ViewSearch& search, const ContourPlannerConfig& scored_with);

  /// Adds a group, or puts it in the place of an earlier one of the same segment.
  void add(std::shared_ptr<const ScoredGroup> group);

  /// Scores of a search's group, null if they are pending: not made yet, or of other contour points.
  const ScoredGroup* of(const SegmentSearch& group) const;

  /// Indices of the pending groups of a search, in the order in which it tries them.
  std::vector<std::uint32_t> pendingIn(const ViewSearch& search) const;

  /// What the scores were made with; groups that are added must be made with the same.
  const ContourPlannerConfig& scoredWith() const { return scored_with_; }

 private:
  ContourPlannerConfig scored_with_;
  std::map<std::int32_t, std::shared_ptr<const ScoredGroup>> of_segment_;
};

/// What a search for other parameters found.
struct SearchAgain {
  /// As searchView() returns it, but: rays and voxels_visited are 0 since none were cast; gain_voxels is 0
  /// until the caller asks countVoxels(); `occupied` is of the margin that the scores were made with;
  /// histograms stay with the kept groups, and PoseScore::histogram is a column of
  /// ScoredGroup::unknown_within. Groups that the search did not reach have no scores; see fillScores().
  ViewSearch search;
  /// Index into search.segments of a group that must be scored before anything can be said; none is chosen
  /// then, and the groups before it hold no view.
  std::optional<std::uint32_t> pending;
};

/// What searchView() would return for `wanted`, from kept scores: no ray is cast. The saliency under another
/// B_th or weighting is that of rescoreSegments(), given in `input.saliency`, whose distances are not read.
/// \throws std::invalid_argument if canSearchAgain() says no, or as searchView(); Cancelled
SearchAgain searchAgain(const ViewSearchInput& input, const ContourPlannerConfig& wanted,
                        const ScoredGroups& groups, const ReachPose& reach, const RunControl& control = {});

/// Ranked scores of one group under `wanted`, as searchAgain() gives them to the groups that it reaches: for
/// tables and pictures of the others. False and no scores if they are pending. \pre canSearchAgain()
bool fillScores(const ViewSearchInput& input, const ContourPlannerConfig& wanted, const ScoredGroups& groups,
                SegmentSearch& group);

}  // namespace vantage
