#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "viewer/inspector_model.h"
#include "viewer/panels/candidate_state.h"
#include "viewer/panels/view_panel.h"
#include "viewer/scene.h"

namespace vantage {

/// A file that is looked at, in a 3-D view of its own.
struct Document {
  /// \param name of the view's widgets, \param wake as InspectorModel's
  Document(GlContext& gl, std::string name, std::function<void()> wake)
      : view_name(std::move(name)), model(std::move(wake)), view(gl, scene, view_name) {}

  std::string view_name;
  CandidateState candidates;
  Scene scene;
  InspectorModel model;
  ViewPanel view;
  bool eye_wanted = false;  ///< the eye is to be placed for what was opened
  std::filesystem::path file_before;
  TimelinePlace place_before;
  LayerSet stage_layers_before;

  /// Layers of the stage that the timeline stands at.
  const LayerSet& stageLayers() const { return model.stages()[model.place().stage].layers; }
};

struct Preferences;

/// One file, or two side by side: looked at from the same place, at the same step and stage as far as both
/// have them. One of them is active: panels and commands are about it.
class Documents {
 public:
  /// \param make gives a document whose view has that name; it begins with one
  explicit Documents(std::function<std::unique_ptr<Document>(std::string name)> make);

  Document& active() const { return *all_[active_]; }
  /// The one that is not active; null if there is one alone.
  Document* other() const { return all_.size() > 1 ? all_[1 - active_].get() : nullptr; }
  /// From left to right.
  const std::vector<std::unique_ptr<Document>>& all() const { return all_; }

  /// Opens files: of those that are shown by themselves the first in the active document, the second beside
  /// it; those that change what is shown, parameters say, in the active one. More than two are told as left
  /// out.
  void open(const std::vector<std::filesystem::path>& files);
  void openBeside(const std::filesystem::path& file);
  /// Makes the other one active; what plays goes on playing.
  void swap();
  void closeOther();

  /// What is drawn of a document: the view that is kept, with the layers of its own planner where the active
  /// one shows a stage.
  ViewSettings viewOf(const Document& document, const ViewSettings& kept) const;
  /// Takes over what became of a document's model since it was last asked: a file or a recipe that was
  /// opened, the stage that the timeline went to and brings its layers. Notices of the other one go to the
  /// active one.
  void take(Document& document, Preferences& preferences);
  /// After the active eye or, if the other view is under the mouse, that one was moved, the other one
  /// follows.
  void linkEyes(bool other_leads);
  /// The other one goes where the active one is.
  void linkSteps();

 private:
  std::function<std::unique_ptr<Document>(std::string)> make_;
  std::vector<std::unique_ptr<Document>> all_;
  std::size_t active_ = 0;
  bool layers_wanted_ = true;  ///< nothing was shown so far

  void takeFile(Document& document, Preferences& preferences);
  void takeStage(Document& document, LayerSet& layers);
};

}  // namespace vantage
