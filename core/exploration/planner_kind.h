#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Who chooses the next view.
enum class PlannerKind : std::uint8_t {
  Contour,       ///< Monica & Aleotti 2017, segment by segment, on the TSDF
  Standard,      ///< its baseline: every contour view over the whole workspace (D-B16)
  Hierarchical,  ///< Vasquez-Gomez et al. 2013, hierarchical ray tracing in the octree
  Uniform,       ///< its baseline: every finest ray of every view (m = 0)
};

/// All of them, in the order of help texts.
inline constexpr PlannerKind kPlannerKinds[] = {PlannerKind::Contour, PlannerKind::Standard,
                                                PlannerKind::Hierarchical, PlannerKind::Uniform};

/// `contour`, `standard`, `hierarchical`, `uniform`.
std::string_view toString(PlannerKind kind);

/// True if it plans on the octree, false if on the TSDF.
constexpr bool usesOctree(PlannerKind kind) {
  return kind == PlannerKind::Hierarchical || kind == PlannerKind::Uniform;
}

/// The planner of each NBV in turn, from names with commas between them; the last one goes on. "a,a,b": a
/// chooses the first two views, b all others. \throws std::invalid_argument naming what is not known and what
/// is.
std::vector<PlannerKind> plannersFromText(std::string_view text);
std::string plannersToText(const std::vector<PlannerKind>& planners);

}  // namespace vantage
