#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "viewer/candidate_table.h"
#include "viewer/explanation.h"

namespace vantage {

/// What the panels about views keep from frame to frame.
struct CandidateState {
  CandidateTable table;
  /// What the table has scrolled to. It scrolls again when another view is selected elsewhere, and when the
  /// view comes to another place or among other rows.
  struct Scrolled {
    std::optional<std::uint32_t> view = {};
    std::optional<std::size_t> place = {};  ///< in CandidateTable::listed()
    CandidateFilter filter = {};
    bool operator==(const Scrolled&) const = default;
  };
  Scrolled scrolled;

  /// Voxels that a view counts, of the last one that was asked for, and what they were counted in.
  struct Counted {
    CountedRegion region;
    std::weak_ptr<const StateGrid> states;
    std::weak_ptr<const RayTree> tree;
    std::uint64_t voxels = 0;
  };
  std::optional<Counted> counted;
};

}  // namespace vantage
