#include "viewer/what_if.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "viewer/candidates.h"

namespace vantage {
namespace {

// Names of background work: the newest of a name replaces the one before.
const std::string kScore = "score views", kRerun = "run stages again", kCheck = "check the view";

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Scores of the step's own search; none for planners on the octree.
std::optional<ScoredGroups> groupsOf(const PlannedStep& step, PlannerKind planner) {
  if (usesOctree(planner) || !step.data.record->search) return std::nullopt;
  return ScoredGroups(*step.data.record->search, contourConfigOf(step.settings, planner));
}

/// What the step lacks of that which planning again starts from; empty if nothing.
std::string lacking(const StepData& data, PlannerKind planner) {
  const StepRecord& record = *data.record;
  if (record.closing) return "nothing was planned after the last scan";
  const bool searched = usesOctree(planner) ? record.utilities != nullptr
                                            : record.search && record.positions && record.point_labels;
  if (!searched) return "the step was cut before its views were searched";
  const bool mapped = usesOctree(planner) ? data.pyramid && data.tree : data.volume != nullptr;
  return mapped ? "" : "the map of the step is not there";
}

}  // namespace

template <class Work, class Finish>
void WhatIf::start(const std::string& name, Work work, Finish finish) {
  work_.start(name, [this, step = step_, work = std::move(work), finish](const RunControl& control) {
    auto result = std::make_shared<decltype(work(control))>();
    std::string failure;
    try {
      *result = work(control);
    } catch (const Cancelled&) {
      throw;
    } catch (const std::exception& e) {
      failure = failureText(e);
    }
    return BackgroundWork::Finish([this, step, result, failure, finish] {
      if (step != step_) return;
      if (failure.empty())
        finish(std::move(*result));
      else
        fail(failure);
    });
  });
}

void WhatIf::fail(const std::string& message) {
  suspend();
  failure_ = message;
  state_ = WhatIfState::Failed;
  ++revision_;
}

void WhatIf::clear() {
  leaveStep();
  recorded_ = shown_ = {};
  edits_.setRecorded({});
  has_settings_ = false;
}

/// Lets go of all that was made for the step, its map too, which the next step may need the room of.
void WhatIf::leaveStep() {
  suspend();
  stopped_ = false;
  ++step_;
  context_.reset();
  recorded_step_.reset();
  base_.reset();
  recorded_groups_.reset();
  groups_.reset();
  state_ = WhatIfState::Unavailable;
  failure_.clear();
  pending_groups_ = 0;
  ++revision_;
}

void WhatIf::setStep(const StepData& recorded, std::shared_ptr<const WhatIfContext> context) {
  leaveStep();
  recorded_ = shown_ = recorded;
  if (!context) return;
  failure_ = lacking(recorded, context->planner);
  if (!failure_.empty()) return;
  if (!has_settings_) edits_.setRecorded(context->settings);
  has_settings_ = true;
  context_ = std::move(context);
  recorded_step_ = base_ = std::make_shared<const PlannedStep>(PlannedStep{recorded_, context_->settings});
  recorded_groups_ = groups_ = groupsOf(*base_, context_->planner);
  state_ = WhatIfState::Recorded;
  update();
  if (state_ != WhatIfState::Recorded) scorePending();
}

void WhatIf::refuse(std::string why) {
  leaveStep();
  failure_ = std::move(why);
}

std::size_t WhatIf::groups() const {
  return recorded_.empty() || !recorded_.record->search ? 0 : shown_.record->search->segments.size();
}

void WhatIf::show(StepData data) {
  shown_ = std::move(data);
  ++revision_;
}

void WhatIf::showRecorded() {
  work_.cancel(kRerun);
  work_.cancel(kCheck);
  restOn(recorded_step_, recorded_groups_);
  state_ = WhatIfState::Recorded;
  failure_.clear();
  show(groups_ ? withAllScores(recorded_, *base_, *groups_, *context_, edits_.recorded()) : recorded_);
}

void WhatIf::update() {
  if (!ready()) return;
  stopped_ = false;
  failure_.clear();
  if (!edits_.anyChanged()) {
    showRecorded();
    scorePending();
    return;
  }
  if (stagesToRedo(*recorded_step_, edits_.wanted(), context_->planner).empty() && base_ != recorded_step_)
    restOn(recorded_step_, recorded_groups_);
  if (stagesToRedo(*base_, edits_.wanted(), context_->planner).empty()) {
    work_.cancel(kRerun);
    rerank();
  } else {
    rerun();
  }
}

void WhatIf::restOn(std::shared_ptr<const PlannedStep> base, std::optional<ScoredGroups> groups) {
  const std::shared_ptr<const PlannedStep> before = std::exchange(base_, std::move(base));
  groups_ = std::move(groups);
  const bool same = !before || before == base_ || sameCandidates(before->data.frame(), base_->data.frame());
  if (!same && other_candidates_) other_candidates_();
}

void WhatIf::rerank() {
  work_.cancel(kCheck);  // of other parameters
  const auto start = Clock::now();
  try {
    Reranked ranked =
        vantage::rerank(*base_, groups_ ? &*groups_ : nullptr, *context_, edits_.wanted(), ReachCheck::Quick);
    show(std::move(ranked.data));
    rerank_s_ = secondsSince(start);
    state_ = ranked.pending ? WhatIfState::Scoring : WhatIfState::Checking;
    if (ranked.pending)
      scorePending();
    else
      check();
  } catch (const std::exception& e) {
    fail(e.what());
  }
}

void WhatIf::check() {
  start(
      kCheck,
      [base = base_, groups = groups_, context = context_,
       wanted = edits_.wanted()](const RunControl& control) {
        control.report("planning the path to the view", 0, 0);
        Reranked ranked =
            vantage::rerank(*base, groups ? &*groups : nullptr, *context, wanted, ReachCheck::Full, control);
        if (groups && !ranked.pending)
          ranked.data = withAllScores(ranked.data, *base, *groups, *context, wanted);
        return ranked;
      },
      [this](Reranked ranked) {
        const bool pending = ranked.pending.has_value();
        show(std::move(ranked.data));
        state_ = pending ? WhatIfState::Scoring : WhatIfState::Settled;
        scorePending();
      });
}

void WhatIf::rerun() {
  state_ = WhatIfState::Rerunning;
  work_.cancel(kCheck);
  cancelScoring();
  start(
      kRerun,
      [base = recorded_step_, context = context_, wanted = edits_.wanted()](const RunControl& control) {
        return std::make_shared<const PlannedStep>(replan(*base, *context, wanted, control));
      },
      [this](std::shared_ptr<const PlannedStep> planned) {
        std::optional<ScoredGroups> groups = groupsOf(*planned, context_->planner);
        restOn(std::move(planned), std::move(groups));
        update();
      });
}

void WhatIf::scorePending() {
  if (!groups_ || !base_->data.record->search) return;
  const ViewSearch& search = *shown_.record->search;
  const std::vector<std::uint32_t> pending = groups_->pendingIn(search);
  pending_groups_ = pending.size();
  if (pending.empty()) {
    cancelScoring();
    return;
  }
  if (isScoringOneOf(pending)) return;  // begun anew at every movement of a slider it would never end
  scoring_ = ScoringJob{base_, search.segments[pending.front()].contour_points};
  start(
      kScore,
      [base = base_, groups = *groups_, context = context_,
       group = search.segments[pending.front()]](const RunControl& control) {
        control.report("scoring views", 0, 0);
        return scoreGroupOf(*base, groups, *context, group, control);
      },
      [this, base = base_](std::shared_ptr<const ScoredGroup> group) {
        scoring_.reset();
        if (base != base_) return;
        groups_->add(group);
        if (base_ == recorded_step_) recorded_groups_->add(std::move(group));
        if (state_ == WhatIfState::Scoring) {
          rerank();
          return;
        }
        scorePending();
        if (pending_groups_ > 0) return;
        show(withAllScores(shown_, *base_, *groups_, *context_, edits_.wanted()));
      });
}

void WhatIf::cancelScoring() {
  work_.cancel(kScore);
  scoring_.reset();
}

bool WhatIf::isScoringOneOf(const std::vector<std::uint32_t>& pending) const {
  if (!scoring_ || scoring_->base != base_) return false;
  const auto& segments = shown_.record->search->segments;
  return std::ranges::any_of(
      pending, [&](std::uint32_t g) { return segments[g].contour_points == scoring_->contour_points; });
}

void WhatIf::suspend() {
  for (const std::string& name : {kRerun, kCheck}) work_.cancel(name);
  cancelScoring();
}

bool WhatIf::busy() const {
  if (cancelled()) return false;
  return state_ == WhatIfState::Rerunning || state_ == WhatIfState::Checking ||
         state_ == WhatIfState::Scoring || pending_groups_ > 0;
}

void WhatIf::cancel() {
  stopped_ = stopped_ || busy();
  suspend();
  if (state_ == WhatIfState::Rerunning || state_ == WhatIfState::Checking || state_ == WhatIfState::Scoring)
    fail("cancelled; results of earlier parameters are shown");
}

void WhatIf::runAgain() {
  if (cancelled()) update();
}

bool WhatIf::set(const std::string& key, const config::Value& value) {
  const bool taken = ready() && edits_.set(key, value);
  if (taken) update();
  return taken;
}

bool WhatIf::setText(const std::string& key, const std::string& text) {
  const bool taken = ready() && edits_.setText(key, text);
  if (taken) update();
  return taken;
}

void WhatIf::reset(const std::string& key) {
  if (edits_.reset(key)) update();
}

void WhatIf::resetAll() {
  if (edits_.resetAll()) update();
}

void WhatIf::undo() {
  if (edits_.undo()) update();
}

void WhatIf::redo() {
  if (edits_.redo()) update();
}

std::vector<std::string> WhatIf::load(const std::string& toml, const std::string& origin) {
  std::vector<std::string> others = edits_.load(toml, origin, context_->planner);
  update();
  return others;
}

std::string stateText(const WhatIf& what_if) {
  switch (what_if.state()) {
    case WhatIfState::Unavailable:
      return what_if.failure().empty() ? "preparing…" : "cannot be tried: " + what_if.failure();
    case WhatIfState::Recorded:
      return "as recorded";
    case WhatIfState::Scoring:
      return "scoring views not needed in the run";
    case WhatIfState::Rerunning:
      return "running the stages again…";
    case WhatIfState::Checking:
      return "planning the path to the view…";
    case WhatIfState::Settled:
      return "what a run would decide with these";
    case WhatIfState::Failed:
      return what_if.failure();
  }
  return "";
}

std::string scoredText(const WhatIf& what_if) {
  if (!what_if.ready()) return "";
  if (what_if.state() == WhatIfState::Rerunning) return "views and map are those of earlier parameters";
  if (what_if.pendingGroups() == 0) return "all views are scored";
  return std::to_string(what_if.pendingGroups()) + " of " + std::to_string(what_if.groups()) +
         " groups of views not scored" +
         (what_if.failed()      ? ": failed"
          : what_if.cancelled() ? ": cancelled"
                                : " yet");
}

}  // namespace vantage
