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

/// Stages of a step of a planner, in the order in which they are done.
const std::vector<StageView>& stageViews(PlannerKind planner);

/// What a step is shown with before anything is chosen: a bit of every stage.
LayerSet overviewLayers(PlannerKind planner);

}  // namespace vantage
