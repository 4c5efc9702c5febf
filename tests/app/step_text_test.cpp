#include "viewer/app/step_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vantage::app {
namespace {

using testing::HasSubstr;
using testing::Not;

bool isUnreachable(Reachability reachability) {
  return reachability == Reachability::NoPath || reachability == Reachability::NoFrame;
}

/// Three views that survived, one that did not; `reachable` says what the robot answered to the first two.
StepRecord record(Reachability first, Reachability second) {
  UtilitySearch search;
  const double unknown[] = {27.0, 412.0, 150.0, 0.0};
  for (std::uint32_t n = 0; n < 4; ++n) {
    ViewUtility& view = search.views.emplace_back();
    view.id = n;
    view.unknown = unknown[n];
    view.utility = 1.0 - 0.1 * n;
    view.rejection = n == 3 ? ViewRejection::Executed : ViewRejection::None;
  }
  search.views[0].reachability = first;
  search.views[1].reachability = second;
  search.ranking = {0, 1, 2};
  search.best_unknown = 412.0;
  search.counts.poses_generated = 4;
  search.counts.poses_above_threshold = 2;
  search.counts.poses_executed_before = 1;
  search.counts.poses_unreachable = isUnreachable(first) + isUnreachable(second);
  for (const std::uint32_t n : {1u, 0u})
    if (search.views[n].reachability == Reachability::Reachable) search.chosen.emplace().id = n;
  if (search.chosen) search.chosen->path.verdict = Reachability::Reachable;
  StepRecord r;
  r.planner = "hierarchical";
  r.utilities = std::make_shared<UtilitySearch>(search);
  return r;
}

TEST(StepText, SaysThatTheChosenViewSeesLessThanTheStopRuleAsks) {
  const StepRecord r = record(Reachability::Reachable, Reachability::NotChecked);
  EXPECT_THAT(stepText(r, 100.0), HasSubstr("sees 27 unknown (another view 412) and"));
  EXPECT_THAT(stepText(r, 20.0), HasSubstr("sees 27 unknown and"));
  EXPECT_THAT(stepText(r, 20.0),
              HasSubstr("0 of 4 views rejected by position, 0 by registration, 1 taken before"));
}

TEST(StepText, CountsBetterOnesThatAreUnreachable) {
  EXPECT_THAT(stepText(record(Reachability::NoPath, Reachability::Reachable), 100.0),
              HasSubstr("1 better one unreachable"));
}

TEST(StepText, TellsWhyThereIsNoView) {
  // The first that could not be reached sees too little: it is not counted among those that see enough.
  StepRecord r = record(Reachability::NoPath, Reachability::NoPath);
  EXPECT_THAT(stepText(r, 100.0),
              HasSubstr("no view: 2 views see enough unknown (100 or more), none can be reached"));
  EXPECT_THAT(stepText(r, 500.0),
              HasSubstr("no view: the best of 3 views left sees 412 unknown, fewer than 500"));
  EXPECT_THAT(stepText(r, 500.0), Not(HasSubstr("reached")));
  const StepRecord frameless = record(Reachability::NoFrame, Reachability::NoFrame);
  EXPECT_THAT(stepText(frameless, 100.0),
              HasSubstr("2 views see enough unknown (100 or more), no recorded frame is left near"));
  UtilitySearch search = *r.utilities;
  search.ranking.clear();
  r.utilities = std::make_shared<UtilitySearch>(search);
  EXPECT_THAT(stepText(r, 100.0), HasSubstr("no view: none is left; 0 of 4 views rejected"));
}

}  // namespace
}  // namespace vantage::app
