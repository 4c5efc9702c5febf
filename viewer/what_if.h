#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/config_fields.h"
#include "viewer/background_work.h"
#include "viewer/replanning.h"
#include "viewer/setting_edits.h"
#include "viewer/step_data.h"

namespace vantage {

/// What is known about a decision under other parameters while it is worked on.
enum class WhatIfState {
  Unavailable,  ///< no step that could be planned again
  Recorded,     ///< nothing is changed
  Scoring,      ///< views must be scored that the run did not need
  Rerunning,    ///< stages are done again
  Checking,     ///< the path to the view is being planned
  Settled,      ///< as a run with these parameters would have decided
  Failed,       ///< see failure()
};

/// Other parameters on a recorded step: thresholds re-rank at once from what was kept, other parameters run
/// their stages again in the background. One thread, the one that polls the work.
class WhatIf {
 public:
  /// \param other_candidates called when the step that is shown numbers its candidates anew
  explicit WhatIf(BackgroundWork& work, std::function<void()> other_candidates = {})
      : work_(work), other_candidates_(std::move(other_candidates)) {}

  /// Another step; parameters that are tried stay. Without a context nothing can be tried: it is being
  /// prepared, or refuse() says why not.
  void setStep(const StepData& recorded, std::shared_ptr<const WhatIfContext> context);
  /// Nothing can be tried on the step. \param why it cannot: "the step was cut before its search"
  void refuse(std::string why);
  /// Another file: nothing is tried any more.
  void clear();
  bool ready() const { return context_ != nullptr; }

  const SettingEdits& edits() const { return edits_; }
  // Changes of parameters; each is taken over at once. See SettingEdits.
  bool set(const std::string& key, const config::Value& value);
  bool setText(const std::string& key, const std::string& text);
  void finishEdit() { edits_.finishEdit(); }
  void reset(const std::string& key);
  void resetAll();
  void undo();
  void redo();
  /// Takes over the planner's parameters that a configuration file sets; returns the other keys that it sets.
  /// See SettingEdits::load(). \pre ready()
  std::vector<std::string> load(const std::string& toml, const std::string& origin);

  WhatIfState state() const { return state_; }
  /// Why it failed, or why nothing can be tried; empty while that is being prepared.
  const std::string& failure() const { return failure_; }
  /// The step under the parameters that are tried; empty if there is none, the recorded one if none is
  /// changed.
  const StepData& shown() const { return shown_; }
  /// Differs whenever shown() does.
  std::uint64_t revision() const { return revision_; }
  /// Groups of contour points that are not scored yet, and all of them.
  std::size_t pendingGroups() const { return pending_groups_; }
  std::size_t groups() const;
  /// Seconds that the last re-ranking took.
  double rerankSeconds() const { return rerank_s_; }
  /// Cancels what runs in the background; what is shown stays until something is changed or run again.
  void cancel();
  /// It was cancelled, or failed, and nothing was changed since.
  bool cancelled() const { return stopped_ || state_ == WhatIfState::Failed; }
  /// Does what was cancelled or failed.
  void runAgain();
  /// Leaves the worker to another step that is about to come; state() stays. resume() if it does not come.
  void suspend();
  void resume() { update(); }
  /// It failed without having been cancelled. Nothing goes on until something is changed or run again.
  bool failed() const { return !stopped_ && state_ == WhatIfState::Failed; }
  /// There is something to cancel.
  bool busy() const;

 private:
  void leaveStep();
  void update();
  void showRecorded();
  /// What the ranking rests on from now on.
  void restOn(std::shared_ptr<const PlannedStep> base, std::optional<ScoredGroups> groups);
  void rerank();
  void rerun();
  void scorePending();
  void cancelScoring();
  bool isScoringOneOf(const std::vector<std::uint32_t>& pending) const;
  void check();
  void show(StepData data);
  /// Runs on the worker and hands its result to `finish` unless the step has changed meanwhile.
  template <class Work, class Finish>
  void start(const std::string& name, Work work, Finish finish);
  void fail(const std::string& message);

  /// Groups are known by their points: their place in the order changes with every threshold.
  struct ScoringJob {
    std::shared_ptr<const PlannedStep> base;
    std::vector<std::uint32_t> contour_points;
  };

  BackgroundWork& work_;
  std::function<void()> other_candidates_;
  SettingEdits edits_;
  bool has_settings_ = false;  ///< of the run that is open
  bool stopped_ = false;       ///< by cancel()
  std::shared_ptr<const WhatIfContext> context_;
  std::shared_ptr<const PlannedStep> recorded_step_;  ///< as recorded
  std::shared_ptr<const PlannedStep> base_;           ///< what the ranking rests on
  std::optional<ScoredGroups> recorded_groups_, groups_;
  StepData recorded_, shown_;
  WhatIfState state_ = WhatIfState::Unavailable;
  std::string failure_;
  std::uint64_t revision_ = 0, step_ = 0;
  std::size_t pending_groups_ = 0;
  std::optional<ScoringJob> scoring_;
  double rerank_s_ = 0.0;
};

/// What state() means, in a line.
std::string stateText(const WhatIf& what_if);

/// How many views are scored, in a line; empty if nothing is known about it.
std::string scoredText(const WhatIf& what_if);

}  // namespace vantage
