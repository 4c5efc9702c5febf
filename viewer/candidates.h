#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/scene_frame.h"

namespace vantage {

/// What became of a candidate view.
enum class ViewVerdict : std::uint8_t {
  Chosen,
  Eligible,        ///< good enough, but another one comes first
  LaterSegment,    ///< above the threshold, but its segment comes after that of the chosen view
  Unreachable,     ///< the robot was asked and cannot take it
  BelowThreshold,  ///< too little gain; hierarchical planner: no utility
  TakenBefore,     ///< near a view that was taken before (D-B15, exclude_executed)
  NotFree,         ///< hierarchical planner: the robot does not fit there
  LittleSurface,   ///< hierarchical planner: too little known surface in view to register the scan (eq. 2)
  Stopped,         ///< hierarchical planner: no view sees h_stop, so none is taken (D-A18)
  Waiting,         ///< above the threshold, but a segment before its own is not scored yet
  Pending,         ///< a whole segment whose views are not scored yet
};

/// How a place in the order differs from that in another decision about the same candidates.
struct RankChange {
  enum class Kind : std::uint8_t {
    None,  ///< it has no place in either, or what it had is not known
    Same,
    Up,  ///< `places` nearer to the front
    Down,
    New,  ///< it had no place, or one behind all that had a known one
    Gone,
  };
  Kind kind = Kind::None;
  std::uint32_t places = 0;
  bool operator==(const RankChange&) const = default;
};

/// One candidate view with everything that decided about it, or a segment that waits to be scored.
struct CandidateRow {
  std::uint32_t id = 0;     ///< of the candidate; 0 if pending
  std::uint32_t group = 0;  ///< index into ViewSearch::segments; 0 for the hierarchical planner
  /// Place among the views in the order in which they are tried, over all segments; 1 = first. Empty below
  /// the threshold, if rejected, and after a pending segment.
  std::optional<std::uint32_t> rank = {};
  RankChange change = {};  ///< see compareRanks()
  ViewVerdict verdict = ViewVerdict::Eligible;
  Reachability reachability = Reachability::NotChecked;
  std::uint32_t segment = 0;     ///< label of its segment; 0 = none, or the planner has none
  std::uint32_t poses = 1;       ///< more of a pending segment
  double saliency = 0.0;         ///< of its segment
  double score = 0.0;            ///< what ranks: gain, rays at full resolution, or utility
  double unknown = 0.0;          ///< rays cast (or voxels) that end on unknown and count
  double occupied = 0.0;         ///< the same on occupied
  double surface = 0.0;          ///< sur(v), hierarchical planner
  double distance_factor = 0.0;  ///< dist(v), hierarchical planner
  double distance_m = 0.0;       ///< straight from where the sensor is

  bool pending() const { return verdict == ViewVerdict::Pending; }
  bool chosen() const { return verdict == ViewVerdict::Chosen; }
  /// Hierarchical planner: its rays were cast, so `unknown` and `occupied` are known.
  bool cast() const { return verdict != ViewVerdict::NotFree && verdict != ViewVerdict::TakenBefore; }
  /// Hierarchical planner: it passed all tests, so its factors and utility are known.
  bool survived() const { return cast() && verdict != ViewVerdict::LittleSurface; }
};

/// All candidates of a step: those with a place by rank, or of contour planners segment after segment, each
/// by decreasing gain, then those of the hierarchical planner that were rejected. One pending row for each
/// segment that is not scored. Empty if no views were evaluated.
std::vector<CandidateRow> candidateRows(const SceneFrame& frame);

/// The two steps ask about the same candidates, so that ids mean the same.
bool sameCandidates(const SceneFrame& a, const SceneFrame& b);

/// Fills `change` of the current rows with what is different from the recorded ones of the same candidates;
/// None for those that have no place only because a segment before their own is not scored yet.
/// \param current in the order of candidateRows()
void compareRanks(std::vector<CandidateRow>& current, const std::vector<CandidateRow>& recorded);

/// What became of it in a word or two, for a narrow column: "chosen", "behind", "in collision".
std::string verdictWord(const CandidateRow& row);

/// What the word of a verdict means: "good enough, but the chosen view comes before it". \param hierarchical
/// of that planner; others have verdicts of their own
std::string_view verdictMeaning(ViewVerdict verdict, bool hierarchical);

}  // namespace vantage
