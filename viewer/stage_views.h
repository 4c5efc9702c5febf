#pragma once

#include <string>
#include <vector>

#include "core/exploration/planner_kind.h"
#include "viewer/view_settings.h"

namespace vantage {

/// One stage inside a step as it is looked at.
struct StageView {
  std::string name;   ///< "contours"; unique among a planner's stages
  std::string title;  ///< on its button: "Contours"
  std::string about;  ///< one line: what the stage makes
  LayerSet layers;    ///< what is shown of it
};

/// What there is to look at.
enum class StepContent {
  Planned,  ///< a step of a run: a view was planned
  Closing,  ///< the map after the last scan of a run
  File,     ///< a map, scene, cloud or mesh by itself, shown like a step
};

/// Stages of a step of a planner, in the order in which they are done; before them "overview", with which a
/// step is shown until something is chosen. \param filtered the step's depth images were filtered
const std::vector<StageView>& stageViews(PlannerKind planner, StepContent content, bool filtered = false);

/// Index of the stage of that name; 0, the overview, if there is none.
int stageNamed(const std::vector<StageView>& stages, const std::string& name);

}  // namespace vantage
