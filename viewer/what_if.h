#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/exploration/replan.h"
#include "core/planners/search_again.h"
#include "io/config_fields.h"
#include "io/config_file.h"
#include "viewer/background_work.h"
#include "viewer/step_data.h"

namespace vantage {

/// What trying parameters on a step needs beside its record.
struct WhatIfContext {
  Settings settings;      ///< of the run
  Exclusions exclusions;  ///< what its earlier steps left out
  std::shared_ptr<const CollisionGrid> collision;
  Pose start = Pose::Identity();  ///< of the sensor, before it moves to the view
};

/// What is known about a changed decision while it is worked on.
enum class WhatIfState {
  Recorded,   ///< nothing is changed
  Scoring,    ///< views are being scored that the run did not need
  Rerunning,  ///< stages are done again
  Checking,   ///< the path to the view is being planned
  Settled,    ///< as a run with these parameters would have decided
  Failed,     ///< see failure()
};

/// Other parameters on a recorded step: thresholds re-rank at once from what was kept, other parameters run
/// their stages again in the background. One thread, that of `work.poll()`.
class WhatIf {
 public:
  explicit WhatIf(BackgroundWork& work);

  /// Another step: the parameters that are tried stay, as far as the step's planner has them. Without a
  /// context (it is being prepared, or the file is no run) nothing can be tried.
  void setStep(const StepData& recorded, std::shared_ptr<const WhatIfContext> context);
  void clear();
  bool ready() const { return context_ != nullptr; }

  // Parameters, by configuration key.
  config::Value value(const std::string& key) const;
  config::Value recordedValue(const std::string& key) const;
  bool changed(const std::string& key) const;
  bool anyChanged() const;
  /// Takes over a value. Moves of one slider that follow each other are one step for undo() until
  /// finishEdit(). A value that is refused leaves everything as it is and sets error(). Returns whether it
  /// was taken.
  bool set(const std::string& key, const config::Value& value);
  /// The same from text as a TOML value, or as it is shown in the parameter's unit.
  bool setText(const std::string& key, const std::string& text);
  void finishEdit() { edit_open_ = false; }
  void reset(const std::string& key);
  void resetAll();
  bool canUndo() const { return done_ > 0; }
  bool canRedo() const { return done_ < edits_.size(); }
  void undo();
  void redo();
  /// Why the last text or value of a key was refused; empty if it was not.
  std::string error(const std::string& key) const;

  /// Changed parameters as a configuration file; a comment alone if there are none.
  std::string toml() const;
  /// Takes over the parameters that a configuration file sets. \throws InputError
  void load(const std::string& toml, const std::string& origin);

  WhatIfState state() const { return state_; }
  const std::string& failure() const { return failure_; }
  /// The step under the parameters that are tried; the recorded one if none is changed.
  const StepData& shown() const { return shown_; }
  /// Differs whenever shown() does.
  std::uint64_t revision() const { return revision_; }
  /// Groups of contour points that are not scored yet, of all.
  std::size_t pendingGroups() const { return pending_groups_; }
  std::size_t groups() const;
  /// Seconds that the last re-ranking took.
  double rerankSeconds() const { return rerank_s_; }
  /// Cancels what runs in the background; what is shown stays.
  void cancel();

 private:
  struct Edit {
    std::string key;
    config::Value before, after;
  };
  struct Base;

  void record(const std::string& key, const config::Value& before, const config::Value& after);
  void apply(const std::string& key, const config::Value& value);
  void update();
  void rerank();
  void rerun(Stage from);
  void scorePending();
  void checkPath();

  BackgroundWork& work_;
  std::shared_ptr<const WhatIfContext> context_;
  std::shared_ptr<const Base> base_;  ///< products that the ranking rests on, and what they were made with
  std::optional<ScoredGroups> groups_;
  StepData recorded_, shown_;
  Settings wanted_;
  std::vector<Edit> edits_;
  std::size_t done_ = 0;
  bool edit_open_ = false;
  std::map<std::string, std::string> errors_;
  WhatIfState state_ = WhatIfState::Recorded;
  std::string failure_;
  std::uint64_t revision_ = 0;
  std::size_t pending_groups_ = 0;
  double rerank_s_ = 0.0;
};

}  // namespace vantage
