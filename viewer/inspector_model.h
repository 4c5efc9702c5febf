#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "viewer/background_work.h"
#include "viewer/file_kind.h"
#include "viewer/player.h"
#include "viewer/run_session.h"
#include "viewer/stage_views.h"
#include "viewer/step_data.h"
#include "viewer/what_if.h"

namespace vantage {

/// A line for the person at the window.
struct Notice {
  enum class Level { Info, Warning, Error };
  Level level = Level::Info;
  std::string text;
  double age_s = 0.0;
};

/// What the window is about: the opened file, the step and stage that are shown, what is selected, what is
/// tried out. Knows no OpenGL and no widgets; slow work is done beside it. One thread.
class InspectorModel {
 public:
  /// \param wake called from any thread when update() has something to do
  explicit InspectorModel(std::function<void()> wake);
  ~InspectorModel();
  InspectorModel(const InspectorModel&) = delete;

  /// Opens a file in the background: a run, a file that is shown like one step, views to be shown over the
  /// step, parameters to be tried, or a recipe. What is open stays until the new one is there; failures
  /// become notices.
  void open(const std::filesystem::path& file);
  /// Opens a file once everything that is being opened is there: parameters for a run, say.
  void openNext(const std::filesystem::path& file) { next_files_.push_back(file); }
  /// Reads the view of a recipe file, on any thread; without it recipes cannot be opened.
  using ReadRecipe = std::function<ViewSettings(const std::filesystem::path&)>;
  ReadRecipe read_recipe;
  /// The view of a recipe that was opened since the last call.
  std::optional<ViewSettings> takeRecipe() { return std::exchange(recipe_, std::nullopt); }
  /// Takes over finished work and lets time pass; true if something that is shown changed.
  bool update(double elapsed_s);
  /// Nothing is loading, computing or playing.
  bool idle() const;

  const std::filesystem::path& file() const { return file_; }
  bool isRun() const { return session_ != nullptr; }
  /// Of the file; null if none is open.
  std::shared_ptr<const RunHeader> header() const { return session_ ? session_->header() : recorded_.header; }
  bool loading() const;
  /// Index of the step that was asked for last, if it could not be read.
  std::optional<int> unreadable() const { return unreadable_; }
  /// The run is still being written.
  bool growing() const { return session_ && !finished_ && !lost_; }

  // Timeline
  Player player;
  const std::vector<StepSummary>& steps() const { return steps_; }
  TimelinePlace place() const { return place_; }
  /// The stages of the step that is shown.
  const std::vector<StageView>& stages() const;
  /// Clamped to what there is. The step is loaded in the background; until it is there the last one is shown.
  void goTo(TimelinePlace place);
  void goToStep(int index) { goTo({index, place_.stage}); }
  void next();
  void previous();

  // What is shown
  /// The step as it was recorded; empty until something is loaded.
  const StepData& recorded() const { return recorded_; }
  /// With what is tried out applied to it.
  const StepData& shown() const;
  /// Differs whenever shown() does.
  std::uint64_t revision() const { return revision_; }
  PlannerKind planner() const;

  /// Parameters that are tried out on the step.
  WhatIf& whatIf() { return what_if_; }
  const WhatIf& whatIf() const { return what_if_; }

  /// Candidate id of the view that is looked at; empty = the chosen one.
  std::optional<std::uint32_t> selected_view;
  /// The view that is explained: the selected one, else the chosen one; empty if there is none.
  std::optional<std::uint32_t> explainedView() const;

  void say(Notice::Level level, std::string text);
  const std::vector<Notice>& notices() const { return notices_; }
  void dismissNotices() { notices_.clear(); }

  BackgroundWork& work() { return work_; }
  const BackgroundWork& work() const { return work_; }

 private:
  BackgroundWork::Finish opened(const std::filesystem::path& file, bool over_step, const ReadRecipe& recipe);
  void takeOver(std::shared_ptr<RunSession> session, std::filesystem::path file);
  void show(StepData data, int index);
  void load(int index);
  void loadFailed(int index);
  /// Makes ready what parameters are tried with.
  void prepare();
  void follow();
  void setSteps(std::vector<StepSummary> steps);

  std::filesystem::path file_;
  std::shared_ptr<RunSession> session_;  ///< used by jobs only, one at a time
  bool finished_ = true;
  bool lost_ = false;  ///< the file is gone or cannot be read any more; another one may come
  bool opening_ = false;
  std::optional<int> unreadable_;
  std::deque<std::filesystem::path> next_files_;
  std::vector<StepSummary> steps_;
  TimelinePlace place_;
  int loaded_ = -1;  ///< index of the step that recorded_ holds
  StepData recorded_;
  std::uint64_t revision_ = 0;
  double since_follow_s_ = 0.0;
  std::optional<ViewSettings> recipe_;
  std::vector<Notice> notices_;
  BackgroundWork work_;  ///< its destructor waits for the job that runs; jobs own what they work on
  WhatIf what_if_;
};

}  // namespace vantage
