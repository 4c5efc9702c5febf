#include "viewer/app/experiments/b2_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

namespace vantage::experiments {
namespace {

std::size_t above(const FirstStep& first, double Segment::*value) {
  const auto valueOf = [&](std::size_t row) {
    const std::int32_t segment = first.record->search->segments[row].segment;
    return segment < 0 ? 0.0 : first.record->saliency->segments[static_cast<std::size_t>(segment)].*value;
  };
  std::map<std::string, double> best;  // of each object
  for (std::size_t row = 0; row < first.rows.size(); ++row)
    if (const std::string& object = first.rows[row].object; !object.empty())
      best[object] = std::max(best[object], valueOf(row));
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [object, highest] : best) least = std::min(least, highest);
  std::size_t count = 0;
  for (std::size_t row = 0; row < first.rows.size(); ++row)
    count += first.rows[row].object.empty() && valueOf(row) > least;
  return count;
}

}  // namespace

NoiseRanks rankNoise(const FirstStep& first) {
  NoiseRanks ranks;
  ranks.others = static_cast<std::size_t>(
      std::ranges::count_if(first.rows, [](const SegmentRow& row) { return row.object.empty(); }));
  ranks.above_by_roundness = above(first, &Segment::roundness);
  ranks.above_by_saliency = above(first, &Segment::saliency);
  return ranks;
}

std::vector<std::string> noisySettings() {
  return {"camera.faults=true", "segmentation.min_segment_supervoxels=0"};
}

Claim judgeNoise(const NoiseRanks& noisy) {
  const bool any = noisy.above_by_roundness > 0;
  return {
      "B2 (b)",
      "noisy segments rank lower once isolation is used",
      "Fig. 9",
      fmt::format("{} of {} segments that are no object stand above the least object by roundness only, {} "
                  "with isolation",
                  noisy.above_by_roundness, noisy.others, noisy.above_by_saliency),
      any ? passIf(noisy.above_by_saliency < noisy.above_by_roundness) : Verdict::NotComparable,
      "S1 at the first view, by a sensor with faults, no filters, small segments not merged"};
}

}  // namespace vantage::experiments
