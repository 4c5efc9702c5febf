#include "viewer/inspector_documents.h"

#include <algorithm>
#include <utility>

#include "viewer/file_kind.h"
#include "viewer/preferences.h"

namespace vantage {
namespace {

constexpr std::size_t kMostFiles = 2;

/// Such files are shown by themselves, others change what is shown.
bool standsAlone(const std::filesystem::path& file) {
  switch (kindOf(file)) {
    case FileKind::Run:
    case FileKind::Tsdf:
    case FileKind::Octree:
    case FileKind::Scene:
    case FileKind::Cloud:
    case FileKind::Mesh:
      return true;
    default:
      return false;
  }
}

}  // namespace

Documents::Documents(std::function<std::unique_ptr<Document>(std::string name)> make)
    : make_(std::move(make)) {
  all_.push_back(make_("view"));
}

void Documents::open(const std::vector<std::filesystem::path>& files) {
  std::size_t alone = 0;
  for (const auto& file : files) {
    const bool by_itself = files.size() > 1 && standsAlone(file);
    if (files.size() > 1 && !by_itself)
      active().model.openNext(file);
    else if (alone == 0)
      active().model.open(file);
    else if (alone < kMostFiles)
      openBeside(file);
    else
      active().model.say(
          Notice::Level::Warning,
          file.filename().string() + " is left out: two files are shown side by side, not more");
    alone += by_itself;
  }
}

void Documents::openBeside(const std::filesystem::path& file) {
  if (!other()) all_.push_back(make_(active().view_name == "view" ? "view 2" : "view"));
  other()->model.open(file);
}

void Documents::swap() {
  if (!other()) return;
  Player& player = active().model.player;
  other()->model.player = player;  // what plays goes on, led by the other one
  player.pause();
  active_ = 1 - active_;
}

void Documents::closeOther() {
  if (!other()) return;
  all_.erase(all_.begin() + static_cast<std::ptrdiff_t>(1 - active_));
  active_ = 0;
}

ViewSettings Documents::viewOf(const Document& document, const ViewSettings& kept) const {
  ViewSettings view = kept;
  if (&document != &active() && kept.layers == active().stageLayers()) view.layers = document.stageLayers();
  return view;
}

void Documents::take(Document& document, Preferences& preferences) {
  InspectorModel& model = document.model;
  if (const auto recipe = model.takeRecipe()) {
    preferences.view = *recipe;
    document.eye_wanted = true;
  }
  if (model.file() != document.file_before) takeFile(document, preferences);
  if (&document != &active()) {  // who looks at one file is told of both
    for (const Notice& notice : model.notices())
      active().model.say(notice.level, model.file().filename().string() + ": " + notice.text);
    model.dismissNotices();
  }
  if (!model.recorded().empty()) takeStage(document, preferences.view.layers);
}

void Documents::takeFile(Document& document, Preferences& preferences) {
  const std::filesystem::path& file = document.model.file();
  const auto& recent = preferences.recent_files;
  const bool first = document.file_before.empty();
  // What is remembered of eye and layers is that of the last file.
  const bool as_last = first && !recent.empty() && recent.front().path == std::filesystem::absolute(file);
  if (&document == &active()) {
    document.eye_wanted |= !as_last;
    if (first && !as_last && !recent.empty()) preferences.view.layers = {};
  }
  document.view.forgetMeasured();
  document.file_before = file;
  document.place_before = document.model.place();
  preferences.addRecent(file);
}

void Documents::takeStage(Document& document, LayerSet& layers) {
  const TimelinePlace place = document.model.place();
  // The same stage of another planner, or of the closing scan, has other layers.
  const bool other_stage =
      place.stage != document.place_before.stage || layers == document.stage_layers_before;
  const bool first = std::exchange(layers_wanted_, false) && layers == LayerSet();
  if (&document == &active() && (first || other_stage)) layers = document.stageLayers();
  document.place_before = place;
  document.stage_layers_before = document.stageLayers();
}

void Documents::linkEyes(bool other_leads) {
  if (!other() || active().model.shown().empty() || other()->model.shown().empty()) return;
  if (active().scene.eye() == other()->scene.eye()) return;
  if (other_leads)
    active().view.follow(other()->view);
  else
    other()->view.follow(active().view);
}

void Documents::linkSteps() {
  if (!other() || other()->model.steps().empty() || active().model.steps().empty()) return;
  const InspectorModel& model = active().model;
  InspectorModel& follower = other()->model;
  const TimelinePlace wanted{std::min(model.place().step, static_cast<int>(follower.steps().size()) - 1),
                             stageNamed(follower.stages(), model.stages()[model.place().stage].name)};
  if (follower.unreadable() == wanted.step) return;  // it was told; asked again it would be told for ever
  if (wanted != follower.place()) follower.goTo(wanted);
}

}  // namespace vantage
