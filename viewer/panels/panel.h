#pragma once

#include <functional>
#include <optional>
#include <string>

#include "viewer/commands.h"
#include "viewer/inspector_model.h"
#include "viewer/panels/candidate_state.h"
#include "viewer/panels/theme.h"
#include "viewer/panels/widgets.h"
#include "viewer/preferences.h"
#include "viewer/scene.h"

namespace vantage {

/// What every panel works with. A panel is a function of it: it submits widgets to Dear ImGui inside the
/// window that is open, and changes model and view as the widgets say.
struct PanelContext {
  InspectorModel& model;
  Preferences& preferences;  ///< the view (layers, looks, clip box) and everything else that is kept
  Scene& scene;              ///< legends; nothing in it is changed by panels
  Widgets& widgets;
  CandidateState& candidates;
  const Commands& commands;
  const Theme& theme;
  std::function<void(const std::string&)> copy;  ///< to the clipboard
  std::function<void(const Eye&)> look_from;     ///< puts the eye of the 3-D view somewhere
};

/// What a panel says that has nothing to show: "loading…" while a file or step is read, else how to begin.
/// Widget: "NAME/loading" or "NAME/empty".
void emptyText(PanelContext& context, const std::string& name, const std::string& hint);

void timelinePanel(PanelContext& context);    ///< curves of the run, transport, stages
void layersPanel(PanelContext& context);      ///< what is shown and how
void whatIfPanel(PanelContext& context);      ///< parameters
void candidatesPanel(PanelContext& context);  ///< table of views
void explainPanel(PanelContext& context);     ///< one view against the winner
void gainsPanel(PanelContext& context);       ///< predicted against realised gain

}  // namespace vantage
