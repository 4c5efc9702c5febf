#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "core/planners/contour_groups.h"
#include "core/raycasting/volume_caster.h"

namespace vantage {
namespace {

/// What one position's casts found: counts per distinct roll, roll r at r % counts.size().
struct PositionCounts {
  std::vector<VisibilityCounts> of_roll;
  std::uint64_t rays = 0;     ///< shared ones once
  std::uint64_t visited = 0;  ///< voxels of those rays
};

/// How the rolls of a position share casts (D-B11).
enum class RollSharing { QuarterTurns, HalfTurns, None };

RollSharing sharingOf(const PinholeCamera& camera, int rolls, GainMeasure measure) {
  const bool rays = measure == GainMeasure::Rays;  // the shared grid counts them alone
  if (rays && rolls % 4 == 0 && sharesQuarterTurnGrid(camera)) return RollSharing::QuarterTurns;
  const bool centred = camera.cx == (camera.width - 1) / 2.0 && camera.cy == (camera.height - 1) / 2.0;
  return rolls % 2 == 0 && centred ? RollSharing::HalfTurns : RollSharing::None;
}

class PositionCaster {
 public:
  PositionCaster(const ViewSearchInput& input, const ContourPlannerConfig& config,
                 const SegmentSearch& search)
      : input_(input),
        views_(config.views),
        camera_(input.camera.reduced(config.gain.reduction)),
        query_(regionQuery(input, config, search)),
        measure_(config.gain.count),
        sharing_(sharingOf(camera_, config.views.rolls, measure_)) {}

  PositionCounts operator()(const ViewPosition& position) const {
    PositionCounts counts;
    if (sharing_ == RollSharing::QuarterTurns)
      castShared(position, counts);
    else
      castEach(position, counts);
    return counts;
  }

 private:
  /// One grid of rays per pose of the first quarter turn; the upright half of it serves roll r and r + half a
  /// turn, the sideways half those a quarter turn on.
  void castShared(const ViewPosition& position, PositionCounts& counts) const {
    const int quarter = views_.rolls / 4;
    counts.of_roll.resize(2 * quarter);
    for (int roll = 0; roll < quarter; ++roll) {
      QuarterTurnCounts turns =
          castQuarterTurns(input_.states, camera_, rolledPose(position, roll, views_), query_);
      counts.rays += turns.rays_cast;
      counts.visited += turns.visited;
      counts.of_roll[roll] = std::move(turns.upright);
      counts.of_roll[roll + quarter] = std::move(turns.sideways);
    }
  }

  void castEach(const ViewPosition& position, PositionCounts& counts) const {
    const int distinct = sharing_ == RollSharing::HalfTurns ? views_.rolls / 2 : views_.rolls;
    for (int roll = 0; roll < distinct; ++roll) {
      const auto cast = measure_ == GainMeasure::Volume ? castThroughUnknown : castUniform;
      counts.of_roll.push_back(cast(input_.states, camera_, rolledPose(position, roll, views_), query_));
      counts.rays += counts.of_roll.back().rays;
      counts.visited += counts.of_roll.back().visited;
    }
  }

  const ViewSearchInput& input_;
  const ContourViewConfig& views_;
  PinholeCamera camera_;
  VisibilityQuery query_;
  GainMeasure measure_;
  RollSharing sharing_;
};

/// Casts for all positions, each into its own slot. The blocks only pace the progress reports.
std::vector<PositionCounts> castAll(const ViewSearchInput& input, const std::vector<std::uint32_t>& positions,
                                    const PositionCaster& cast, const RunControl& control) {
  constexpr std::size_t kBlock = 128;
  std::vector<PositionCounts> counts(positions.size());
  for (std::size_t begin = 0; begin < positions.size(); begin += kBlock) {
    const std::size_t end = std::min(positions.size(), begin + kBlock);
    tbb::parallel_for(begin, end, [&](std::size_t n) {
      control.check();
      counts[n] = cast(input.positions[positions[n]]);
    });
    control.report("score poses", end, positions.size());
  }
  return counts;
}

/// The scores of one position's rolls.
void appendScores(const ContourPlannerConfig& config, const ViewPosition& position,
                  const PositionCounts& counts, SegmentSearch& search) {
  const auto distinct = static_cast<int>(counts.of_roll.size());
  const auto first_histogram = static_cast<std::int32_t>(search.histograms.size());
  const bool rays = config.gain.count == GainMeasure::Rays;
  for (int roll = 0; roll < config.views.rolls; ++roll) {
    const VisibilityCounts& c = counts.of_roll[roll % distinct];
    PoseScore score;
    score.id = position.first_id + static_cast<std::uint32_t>(roll);
    score.unknown = static_cast<std::uint32_t>(rays ? c.unknown : c.unknown_voxels);
    score.occupied = static_cast<std::uint32_t>(c.occupied);
    score.gain = score.unknown * config.gain.perUnknown();
    if (!c.histogram.empty()) score.histogram = first_histogram + roll % distinct;
    search.scores.push_back(score);
  }
  for (const VisibilityCounts& c : counts.of_roll)
    if (!c.histogram.empty()) search.histograms.push_back(c.histogram);
}

}  // namespace

void markExecuted(const ViewSearchInput& input, const ContourPlannerConfig& config,
                  std::vector<PoseScore>& scores) {
  const GainConfig& gain = config.gain;
  const auto rolls = static_cast<std::uint32_t>(config.views.rolls);
  std::vector<Pose> near;  // executed at the position at hand
  std::optional<std::uint32_t> at;
  for (PoseScore& score : scores) {
    const std::uint32_t n = score.id / rolls;
    const ViewPosition& position = input.positions.at(n);
    if (at != n) {
      at = n;
      near.clear();
      if (gain.exclude_executed)
        std::ranges::copy_if(input.executed, std::back_inserter(near), [&](const Pose& e) {
          return (e.translation() - position.T_world_camera.translation()).norm() <= gain.executed_distance_m;
        });
    }
    score.executed_before = std::ranges::any_of(near, [&](const Pose& e) {
      return isNear(e, rolledPose(position, static_cast<int>(score.id % rolls), config.views),
                    gain.executed_distance_m, gain.executed_angle_rad);
    });
  }
}

void rankByGain(std::vector<PoseScore>& scores) {
  std::vector<std::uint64_t> order(scores.size());  // most unknown first, then the order of ids
  for (std::size_t n = 0; n < scores.size(); ++n)
    order[n] = std::uint64_t{~scores[n].unknown} << 32 | static_cast<std::uint32_t>(n);
  std::sort(order.begin(), order.end());
  std::vector<PoseScore> ranked;
  ranked.reserve(scores.size());
  for (const std::uint64_t entry : order) ranked.push_back(scores[static_cast<std::uint32_t>(entry)]);
  scores = std::move(ranked);
}

std::uint64_t countVoxels(const ViewSearchInput& input, const ContourPlannerConfig& config,
                          const SegmentSearch& search, const Pose& T_world_camera) {
  VisibilityQuery region = regionQuery(input, config, search);
  region.histogram_bins = 0;
  region.distinct_voxels = true;
  return castUniform(input.states, input.camera, T_world_camera, region).unknown_voxels;
}

void scoreSegment(const ViewSearchInput& input, const ContourPlannerConfig& config, SegmentSearch& search,
                  SearchCounts& counts, const RunControl& control) {
  const std::vector<std::uint32_t> positions = positionsOf(input, search);
  const PositionCaster cast(input, config, search);
  const std::vector<PositionCounts> found = castAll(input, positions, cast, control);

  search.sphere = regionQuery(input, config, search).sphere.value_or(Sphere{});
  search.poses_generated = static_cast<std::uint32_t>(positions.size()) * config.views.rolls;
  search.scores.clear();
  search.histograms.clear();
  search.scores.reserve(search.poses_generated);
  for (std::size_t n = 0; n < positions.size(); ++n) {
    appendScores(config, input.positions[positions[n]], found[n], search);
    counts.rays += found[n].rays;
    counts.voxels_visited += found[n].visited;
  }
  markExecuted(input, config, search.scores);
  rankByGain(search.scores);
  search.scored = true;
  counts.poses_scored += search.scores.size();
  counts.poses_above_threshold += static_cast<std::uint64_t>(
      std::count_if(search.scores.begin(), search.scores.end(),
                    [&](const PoseScore& s) { return s.gain > config.gain.gain_threshold; }));
}

}  // namespace vantage
