#pragma once

#include <bit>
#include <cstdint>
#include <optional>

#include "core/exploration/step_record.h"

namespace vantage {

/// Some of the planning stages, Contours to Evaluation.
class StageSet {
 public:
  /// `first` and every planning stage after it.
  static StageSet from(Stage first) {
    StageSet set;
    for (Stage s = Stage::Contours; s <= Stage::Evaluation; s = next(s))
      if (s >= first) set.add(s);
    return set;
  }
  void add(Stage stage) { bits_ |= bit(stage); }
  bool has(Stage stage) const { return (bits_ & bit(stage)) != 0; }
  bool empty() const { return bits_ == 0; }
  int count() const { return std::popcount(bits_); }
  bool operator==(const StageSet&) const = default;

  /// The earliest one, empty if there is none.
  std::optional<Stage> first() const {
    for (Stage s = Stage::Contours; s <= Stage::Evaluation; s = next(s))
      if (has(s)) return s;
    return std::nullopt;
  }

  /// With the stages whose input changes too. Contours and surface don't depend on each other.
  StageSet withDependents() const {
    StageSet set = *this;
    if (set.has(Stage::Surface)) set.add(Stage::Segmentation);
    if (set.has(Stage::Segmentation)) set.add(Stage::Saliency);
    if (set.has(Stage::Contours) || set.has(Stage::Segmentation)) set.add(Stage::Generation);
    if (!set.empty()) set.add(Stage::Evaluation);
    return set;
  }

 private:
  static std::uint32_t bit(Stage stage) { return 1u << static_cast<int>(stage); }
  static Stage next(Stage stage) { return static_cast<Stage>(static_cast<int>(stage) + 1); }
  std::uint32_t bits_ = 0;
};

}  // namespace vantage
