#include "viewer/inspector_documents.h"

#include <algorithm>

#include "viewer/file_kind.h"

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
