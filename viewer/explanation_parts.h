#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/explanation.h"

namespace vantage {

/// A candidate and what it is measured against; `row` is null if its segment is not scored.
struct ExplainedView {
  const SceneFrame& frame;
  std::uint32_t id;
  const CandidateRow* row;
  const CandidateRow* chosen;          ///< null if none is
  const CandidateRow* other;           ///< see Explanation::other
  std::optional<std::uint32_t> group;  ///< contour planners: its segment's place in the order
};

std::vector<ViewFactor> contourFactors(const ExplainedView& view);
std::vector<ViewFactor> utilityFactors(const ExplainedView& view);
std::string contourReason(const ExplainedView& view);
std::string utilityReason(const ExplainedView& view);

}  // namespace vantage
