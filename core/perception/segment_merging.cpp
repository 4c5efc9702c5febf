#include "core/perception/segment_merging.h"

#include <numeric>
#include <set>
#include <utility>

namespace vantage {

namespace {

/// Disjoint sets of labels whose representative is the lowest label.
class LabelSets {
 public:
  explicit LabelSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t label) {
    while (parent_[label] != label) label = parent_[label] = parent_[parent_[label]];
    return label;
  }
  /// Returns the label that remains.
  std::uint32_t join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    return parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Segments with their sizes and neighbours, joined from the smallest upward.
class SmallSegmentMerger {
 public:
  SmallSegmentMerger(LabelSets& sets, const std::vector<std::uint8_t>& exists,
                     const std::vector<SupervoxelLink>& links)
      : sets_(sets), size_(exists.size(), 0), neighbours_(exists.size()) {
    for (std::uint32_t label = 0; label < exists.size(); ++label) {
      if (exists[label]) ++size_[sets_.find(label)];
    }
    for (const SupervoxelLink& link : links) {
      const std::uint32_t a = sets_.find(link.a), b = sets_.find(link.b);
      if (a == b) continue;
      neighbours_[a].insert(b);
      neighbours_[b].insert(a);
    }
  }

  void run(std::uint32_t limit) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> small;  // (size, label)
    const auto offer = [&](std::uint32_t label) {
      if (size_[label] > 0 && size_[label] <= limit && !neighbours_[label].empty()) {
        small.insert({size_[label], label});
      }
    };
    for (std::uint32_t label = 0; label < size_.size(); ++label) offer(label);
    while (!small.empty()) {
      const std::uint32_t label = small.begin()->second;
      small.erase(small.begin());
      const std::uint32_t into = largestNeighbour(label);
      small.erase({size_[into], into});
      offer(merge(label, into));
    }
  }

 private:
  std::uint32_t largestNeighbour(std::uint32_t label) const {
    std::uint32_t best = *neighbours_[label].begin();
    for (const std::uint32_t other : neighbours_[label]) {
      if (size_[other] > size_[best]) best = other;
    }
    return best;
  }

  std::uint32_t merge(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t kept = sets_.join(a, b), gone = kept == a ? b : a;
    size_[kept] += std::exchange(size_[gone], 0);
    for (const std::uint32_t other : neighbours_[gone]) {
      neighbours_[other].erase(gone);
      if (other == kept) continue;
      neighbours_[other].insert(kept);
      neighbours_[kept].insert(other);
    }
    neighbours_[gone].clear();
    return kept;
  }

  LabelSets& sets_;
  std::vector<std::uint32_t> size_;
  std::vector<std::set<std::uint32_t>> neighbours_;
};

}  // namespace

std::vector<std::uint32_t> groupSupervoxels(const std::vector<std::uint8_t>& exists,
                                            const std::vector<SupervoxelLink>& links, int min_supervoxels) {
  LabelSets sets(exists.size());
  for (const SupervoxelLink& link : links) {
    if (link.convex) sets.join(link.a, link.b);
  }
  if (min_supervoxels > 0) {
    SmallSegmentMerger(sets, exists, links).run(static_cast<std::uint32_t>(min_supervoxels));
  }
  std::vector<std::uint32_t> segment(exists.size(), kNoSegment);
  for (std::uint32_t label = 0; label < exists.size(); ++label) {
    if (exists[label]) segment[label] = sets.find(label);
  }
  return segment;
}

}  // namespace vantage
