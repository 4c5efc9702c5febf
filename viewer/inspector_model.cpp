#include "viewer/inspector_model.h"

#include <algorithm>

#include "io/error.h"
#include "io/table_file.h"
#include "io/text_file.h"
#include "viewer/map_session.h"

namespace vantage {
namespace {

constexpr double kFollowEvery_s = 0.5, kWatchEvery_s = 2.0;  // a run that grows, and one that is whole
constexpr double kInfoShown_s = 8.0;
constexpr std::size_t kMostNotices = 4;

// Names of background work: the newest of a name replaces the one before.
const std::string kOpen = "open", kLoad = "load step", kPrepare = "prepare", kFollow = "follow",
                  kAhead = "read ahead";

/// What of a configuration file planning again does not ask for; empty for none.
std::string leftOut(const std::vector<std::string>& keys) {
  constexpr std::size_t kNamed = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(keys.size(), kNamed); ++i) text += (i ? ", " : "") + keys[i];
  if (keys.size() > kNamed) text += " and " + std::to_string(keys.size() - kNamed) + " more";
  return text.empty() ? "" : "; left as in the run, since planning again does not ask for it: " + text;
}

}  // namespace

InspectorModel::InspectorModel(std::function<void()> wake)
    : work_(std::move(wake)), what_if_(work_, [this] { selected_view.reset(); }) {
  work_.onFailure([this](const std::string& name, const std::string& message) {
    if (name == kOpen) opening_ = false;
    if (name == kLoad) loadFailed(place_.step);
    if (name == kPrepare) what_if_.refuse(message);
    say(Notice::Level::Error, message);
  });
}

InspectorModel::~InspectorModel() = default;

void InspectorModel::say(Notice::Level level, std::string text) {
  const auto same = std::ranges::find(notices_, text, &Notice::text);
  if (same != notices_.end()) notices_.erase(same);
  notices_.push_back({level, std::move(text), 0.0});
  if (notices_.size() > kMostNotices) notices_.erase(notices_.begin());
}

bool InspectorModel::loading() const {
  return opening_ || (isRun() && !steps_.empty() && loaded_ != place_.step && !unreadable_);
}

bool InspectorModel::idle() const {
  return !player.playing() && !loading() && !work_.busy() && next_files_.empty();
}

void InspectorModel::open(const std::filesystem::path& file) {
  opening_ = true;
  work_.start(kOpen,
              [this, file, over_step = !recorded_.empty(),
               recipe = read_recipe](const RunControl& control) -> BackgroundWork::Finish {
                control.report("opening " + file.filename().string(), 0, 0);
                return opened(file, over_step, recipe);
              });
}

/// Reads a file, on the worker: nothing of the model may be touched but by what it returns.
BackgroundWork::Finish InspectorModel::opened(const std::filesystem::path& file, bool over_step,
                                              const ReadRecipe& recipe) {
  const std::string name = file.filename().string();
  switch (requireKind(file)) {
    case FileKind::Run:
      return [this, session = std::make_shared<RunSession>(file), file] { takeOver(session, file); };
    case FileKind::Config:
      return [this, text = readTextFile(file), file, name] {
        opening_ = false;
        if (!what_if_.ready()) {
          if (!isRun()) throw InputError(name, "holds parameters; open a run to try them on first");
          if (!what_if_.failure().empty())
            throw InputError(name, "cannot be tried here: " + what_if_.failure());
          openNext(file);  // the step is being prepared
          return;
        }
        const std::vector<std::string> others = what_if_.load(text, file.string());
        say(others.empty() ? Notice::Level::Info : Notice::Level::Warning,
            "the parameters of " + name + " are tried" + leftOut(others));
      };
    case FileKind::Recipe:
      if (!recipe) throw InputError(name, "is a recipe, which cannot be read here");
      return [this, view = recipe(file), name] {
        opening_ = false;
        recipe_ = view;
        say(Notice::Level::Info, "the view of recipe " + name);
      };
    case FileKind::Views:
      if (over_step)
        return [this, views = readViews(file), name] {
          opening_ = false;
          work_.cancel(kPrepare);
          selected_view.reset();
          recorded_ = withViews(recorded_, views);
          what_if_.setStep(recorded_, nullptr);
          what_if_.refuse("other views are shown over the step");
          ++revision_;
          say(Notice::Level::Info, std::to_string(views.size()) + " views of " + name + " over the step");
        };
      break;
    case FileKind::Dataset:
      throw InputError(name, "is a recorded sequence; explore it first: vantage explore " + file.string());
    default:
      break;
  }
  std::vector<std::string> warnings;
  StepData data = openAsStep(file, &warnings);
  return [this, data = std::move(data), file, warnings] {
    takeOver(nullptr, file);
    show(data, 0);
    for (const std::string& warning : warnings) say(Notice::Level::Warning, warning);
  };
}

void InspectorModel::takeOver(std::shared_ptr<RunSession> session, std::filesystem::path file) {
  opening_ = false;
  work_.cancel(kLoad);
  work_.cancel(kPrepare);
  work_.cancel(kAhead);
  work_.cancel(kFollow);
  file_ = std::move(file);
  session_ = std::move(session);
  player.pause();
  selected_view.reset();
  what_if_.clear();
  recorded_ = {};
  loaded_ = -1;
  unreadable_.reset();
  place_ = {};
  ++revision_;
  steps_.clear();
  finished_ = true;
  lost_ = false;
  if (!session_) return;
  setSteps(session_->summaries());
  finished_ = session_->finished();
  if (steps_.empty())
    say(Notice::Level::Info, file_.filename().string() + ": no step is finished yet; it is followed");
  else
    load(0);
}

void InspectorModel::setSteps(std::vector<StepSummary> steps) {
  steps_ = std::move(steps);
  if (place_.step >= static_cast<int>(steps_.size()))
    place_.step = std::max(0, static_cast<int>(steps_.size()) - 1);
}

void InspectorModel::goTo(TimelinePlace place) {
  if (steps_.empty()) {
    place_.stage = std::clamp(place.stage, 0, static_cast<int>(stages().size()) - 1);
    return;
  }
  place.step = std::clamp(place.step, 0, static_cast<int>(steps_.size()) - 1);
  const bool other = place.step != place_.step || loaded_ != place.step;
  place_.step = place.step;
  place_.stage = std::clamp(place.stage, 0, static_cast<int>(stages().size()) - 1);
  if (other) load(place.step);
}

void InspectorModel::next() {
  TimelinePlace place = place_;
  if (player.next(place, static_cast<int>(steps_.size()), static_cast<int>(stages().size()))) goTo(place);
}

void InspectorModel::previous() {
  TimelinePlace place = place_;
  if (player.previous(place, static_cast<int>(stages().size()))) goTo(place);
}

void InspectorModel::load(int index) {
  const int step = steps_[index].step;
  unreadable_.reset();
  work_.cancel(kPrepare);
  work_.cancel(kAhead);
  what_if_.suspend();  // the worker is wanted for the step
  work_.start(kLoad, [this, session = session_, step, index](const RunControl& control) {
    control.report("loading step " + std::to_string(step), 0, 0);
    StepData data = session->load(step);
    return BackgroundWork::Finish([this, data = std::move(data), index] { show(data, index); });
  });
}

/// What was shown stays, and so does its place.
void InspectorModel::loadFailed(int index) {
  unreadable_ = index;
  player.pause();
  if (loaded_ >= 0) place_.step = loaded_;
  if (what_if_.ready())
    what_if_.resume();
  else if (loaded_ >= 0 && what_if_.failure().empty())
    prepare();
}

void InspectorModel::show(StepData data, int index) {
  const std::string stage = stages()[place_.stage].name;
  recorded_ = std::move(data);
  place_.stage = stageNamed(stages(), stage);  // a run may change planners from step to step
  loaded_ = index;
  ++revision_;
  selected_view.reset();
  what_if_.setStep(recorded_, nullptr);
  if (!session_ || index != place_.step) return;
  prepare();
  if (index + 1 < static_cast<int>(steps_.size()))
    work_.start(kAhead, [session = session_, next = steps_[index + 1].step](const RunControl& control) {
      control.report("reading ahead", 0, 0);
      session->prepare(next);
      return BackgroundWork::Finish();
    });
}

void InspectorModel::prepare() {
  if (recorded_.record->closing) {
    what_if_.refuse("nothing was planned on the map after the last scan");
    return;
  }
  work_.start(kPrepare,
              [this, session = session_, data = recorded_, index = loaded_](const RunControl& control) {
                control.report("preparing what-if", 0, 0);
                auto context = makeWhatIfContext(data, session->exclusionsBefore(data.record->step));
                return BackgroundWork::Finish([this, context = std::move(context), index] {
                  if (loaded_ == index) what_if_.setStep(recorded_, context);
                });
              });
}

void InspectorModel::follow() {
  const auto running = work_.running();  // the news of a job that another one replaces would be lost
  if (std::ranges::any_of(running, [](const BackgroundProgress& work) { return work.name == kFollow; }))
    return;
  work_.start(kFollow, [this, session = session_, finished = finished_, lost = lost_](const RunControl&) {
    const Followed news = session->refresh();
    Followed nothing;
    nothing.finished = finished;
    const bool well = !news.gone && news.problem.empty();
    if (lost ? !well : news == nothing) return BackgroundWork::Finish();  // nor is anything drawn
    std::vector<StepSummary> steps;
    if (news.grown || news.replaced || news.finished) steps = session->summaries();
    return BackgroundWork::Finish([this, news, steps = std::move(steps)]() mutable {
      const std::string name = file_.filename().string();
      if (news.gone || !news.problem.empty()) {
        lost_ = true;
        say(Notice::Level::Warning, (news.gone ? name + " is gone" : news.problem) +
                                        "; steps are shown as far as they can still be read");
        return;
      }
      if (news.replaced) {
        say(Notice::Level::Info, name + " was written anew; it is opened again");
        open(file_);
        return;
      }
      if (std::exchange(lost_, false)) say(Notice::Level::Info, name + " can be read again");
      if (news.grown) {
        const bool at_end = place_.step + 1 >= static_cast<int>(steps_.size());
        const bool first = steps_.empty();
        setSteps(std::move(steps));
        if (first || (at_end && what_if_.state() == WhatIfState::Recorded))
          goToStep(static_cast<int>(steps_.size()) - 1);
      }
      if (news.finished) finished_ = true;
    });
  });
}

bool InspectorModel::update(double elapsed_s) {
  bool changed = work_.poll();
  const bool was_playing = player.playing();
  const std::uint64_t before = revision_;
  if (player.playing() && !loading()) {
    const TimelinePlace at = player.advanced(place_, static_cast<int>(steps_.size()),
                                             static_cast<int>(stages().size()), elapsed_s);
    if (at != place_) {
      goTo(at);
      changed = true;
    }
  }
  changed |= was_playing != player.playing();
  since_follow_s_ += elapsed_s;
  if (session_ && since_follow_s_ >= (growing() ? kFollowEvery_s : kWatchEvery_s)) {
    since_follow_s_ = 0.0;
    follow();
  }
  if (!next_files_.empty() && !loading() && !work_.busy()) {
    const std::filesystem::path next = next_files_.front();
    next_files_.pop_front();
    open(next);
  }
  for (Notice& notice : notices_) notice.age_s += elapsed_s;
  changed |= std::erase_if(notices_, [](const Notice& n) {
               return n.level == Notice::Level::Info && n.age_s > kInfoShown_s;
             }) > 0;
  return changed || revision_ != before;
}

const StepData& InspectorModel::shown() const {
  return what_if_.shown().empty() ? recorded_ : what_if_.shown();
}

PlannerKind InspectorModel::planner() const {
  if (!recorded_.empty()) return plannerOfStep(recorded_);
  return PlannerKind::Contour;
}

const std::vector<StageView>& InspectorModel::stages() const {
  if (!isRun()) return stageViews(planner(), StepContent::File);
  const bool closing = !recorded_.empty() && recorded_.record->closing;
  const bool filtered = !recorded_.empty() && recorded_.record->filtered;
  return stageViews(planner(), closing ? StepContent::Closing : StepContent::Planned, filtered);
}

std::optional<std::uint32_t> InspectorModel::explainedView() const {
  if (selected_view) return selected_view;
  const StepData& data = shown();
  if (data.empty() || !data.record->hasView()) return std::nullopt;
  return data.record->chosen()->id;
}

}  // namespace vantage
