#pragma once

#include <cstdint>
#include <optional>

#include "viewer/candidate_table.h"

namespace vantage {

/// What the panels about views keep from frame to frame.
struct CandidateState {
  CandidateTable table;
  /// The view that the table has scrolled to: it scrolls again when another one is selected elsewhere.
  std::optional<std::uint32_t> scrolled_to;

  /// Voxels that a view counts, of the last one that was asked for.
  struct Counted {
    std::uint64_t revision = 0;  ///< of the table
    std::uint32_t id = 0;
    std::uint64_t voxels = 0;
  };
  std::optional<Counted> counted;
};

}  // namespace vantage
