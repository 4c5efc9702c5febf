#include "core/exploration/replan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <stdexcept>
#include <string>

#include "core/exploration/plan_view.h"
#include "core/planners/rank_again.h"
#include "core/planners/search_again.h"
#include "tests/support/synthetic_record.h"

namespace vantage {
namespace {

using testing::ElementsAre;

MotionPlan lowViewsOnly(const Pose& pose) {
  MotionPlan plan;
  plan.verdict = pose.translation().z() > 0.45 ? Reachability::OutOfReach : Reachability::Reachable;
  return plan;
}

PlanViewInput inputFor(const test::SyntheticRun& r, const ContourPlannerConfig& config) {
  return {r.volume, r.states, r.header.camera, r.header.workspace, config};
}

/// Planned with few rays.
const test::SyntheticRun& run() {
  static const test::SyntheticRun kRun = [] {
    test::SyntheticRun r = test::makeSyntheticRun();
    r.header.contour_config.gain.reduction = 4;
    planView(r.record, inputFor(r, r.header.contour_config), lowViewsOnly, [](Stage) {}, {});
    return r;
  }();
  return kRun;
}

PlanViewInput inputFor(const ContourPlannerConfig& config) {
  return inputFor(run(), config);
}

/// The stages that were published.
std::vector<Stage> plan(StepRecord& record, const ContourPlannerConfig& config, const StageSet& stages) {
  std::vector<Stage> published;
  planView(
      record, inputFor(config), lowViewsOnly, [&](Stage s) { published.push_back(s); }, {}, stages);
  return published;
}

void expectSameSearch(const ViewSearch& a, const ViewSearch& b) {
  ASSERT_EQ(a.segments.size(), b.segments.size());
  for (std::size_t s = 0; s < a.segments.size(); ++s) {
    EXPECT_EQ(a.segments[s].segment, b.segments[s].segment);
    EXPECT_EQ(a.segments[s].saliency, b.segments[s].saliency);
    EXPECT_EQ(a.segments[s].contour_points, b.segments[s].contour_points);
    ASSERT_EQ(a.segments[s].scores.size(), b.segments[s].scores.size());
    for (std::size_t r = 0; r < a.segments[s].scores.size(); ++r) {
      EXPECT_EQ(a.segments[s].scores[r].id, b.segments[s].scores[r].id);
      EXPECT_EQ(a.segments[s].scores[r].gain, b.segments[s].scores[r].gain);
      EXPECT_EQ(a.segments[s].scores[r].reachability, b.segments[s].scores[r].reachability);
    }
  }
  ASSERT_EQ(a.chosen.has_value(), b.chosen.has_value());
  if (a.chosen) {
    EXPECT_EQ(a.chosen->id, b.chosen->id);
    EXPECT_EQ(a.chosen->gain_voxels, b.chosen->gain_voxels);
  }
}

void expectSameProducts(const StepRecord& a, const StepRecord& b) {
  ASSERT_TRUE(a.search && b.search);
  EXPECT_EQ(a.contours->points.size(), b.contours->points.size());
  EXPECT_EQ(a.surface->points, b.surface->points);
  EXPECT_EQ(*a.point_labels, *b.point_labels);
  EXPECT_EQ(a.positions->size(), b.positions->size());
  ASSERT_EQ(!a.labels, !b.labels);
  ASSERT_EQ(!a.saliency, !b.saliency);
  if (a.labels) {
    EXPECT_EQ(a.labels->of_point, b.labels->of_point);
    ASSERT_EQ(a.saliency->segments.size(), b.saliency->segments.size());
    for (std::size_t s = 0; s < a.saliency->segments.size(); ++s)
      EXPECT_EQ(a.saliency->segments[s].saliency, b.saliency->segments[s].saliency);
  }
  expectSameSearch(*a.search, *b.search);
}

/// A change of the configuration and the stages that it touches.
struct Change {
  const char* name;
  std::function<void(ContourPlannerConfig&)> make;
  std::vector<Stage> stages;
};

const std::vector<Change>& changes() {
  using C = ContourPlannerConfig;
  static const std::vector<Change> kChanges = {
      {"A_th",
       [](C& c) { c.contours.group_angle_rad = 0.3; },
       {Stage::Contours, Stage::Generation, Stage::Evaluation}},
      {"W_th",
       [](C& c) { c.contours.weight_threshold = 8; },
       {Stage::Contours, Stage::Surface, Stage::Segmentation, Stage::Saliency, Stage::Generation,
        Stage::Evaluation}},
      {"concavity",
       [](C& c) { c.segmentation.concavity_tolerance_rad = 0.05; },
       {Stage::Segmentation, Stage::Saliency, Stage::Generation, Stage::Evaluation}},
      {"distance cap", [](C& c) { c.saliency.max_distance_m = 0.1; }, {Stage::Saliency, Stage::Evaluation}},
      {"tilt", [](C& c) { c.views.tilt_rad = 0.2; }, {Stage::Generation, Stage::Evaluation}},
      {"reduction", [](C& c) { c.gain.reduction = 3; }, {Stage::Evaluation}},
      {"reduction and B_th",
       [](C& c) {
         c.gain.reduction = 3;
         c.saliency.isolation_distance_m = 0.05;
       },
       {Stage::Evaluation}},
      {"odd margin", [](C& c) { c.gain.sphere_margin_m = 0.155; }, {Stage::Evaluation}},
      {"baseline", [](C& c) { c.segment_by_segment = false; }, {Stage::Generation, Stage::Evaluation}},
      {"nothing but the ranking",
       [](C& c) {
         c.saliency.isolation_distance_m = 0.05;
         c.saliency.min_points = 50;
         c.saliency.use_roundness = false;
         c.gain.gain_threshold = 300;
         c.gain.sphere_margin_m = 0.1;
       },
       {}}};
  return kChanges;
}

TEST(StagesToRedo, AreThoseThatTheChangeTouches) {
  const ContourPlannerConfig have;
  for (const Change& change : changes()) {
    ContourPlannerConfig want = have;
    change.make(want);
    StageSet expected;
    for (const Stage stage : change.stages) expected.add(stage);
    EXPECT_EQ(stagesToRedo(have, want), expected) << change.name;
    EXPECT_EQ(firstStageToRedo(have, want),
              change.stages.empty() ? std::nullopt : std::optional(change.stages.front()))
        << change.name;
  }
  ContourPlannerConfig baseline;  // it knows no segments
  baseline.segment_by_segment = false;
  EXPECT_EQ(firstStageToRedo(baseline, have), Stage::Segmentation);
  ContourPlannerConfig other = baseline;
  other.segmentation.seed_m = 0.05;
  other.gain.sphere_margin_m = 0.123;
  EXPECT_EQ(firstStageToRedo(baseline, other), std::nullopt);
}

TEST(StagesToRedo, OfTheHierarchicalPlanner) {
  const HierarchicalPlannerConfig have;
  const auto first = [&](auto change) {
    HierarchicalPlannerConfig want = have;
    change(want);
    return firstStageToRedo(have, want);
  };
  EXPECT_EQ(first([](auto&) {}), std::nullopt);
  EXPECT_EQ(first([](auto& c) { c.min_occupied = 1; }), std::nullopt);
  EXPECT_EQ(first([](auto& c) { c.body_m = 0.2; }), Stage::Evaluation);
  EXPECT_EQ(first([](auto& c) { c.refine_unknown = true; }), Stage::Evaluation);
  EXPECT_EQ(first([](auto& c) { c.sphere_radius_m = 0.8; }), Stage::Generation);
}

TEST(PlanView, DoesOnlyWhatAChangeTouchesAndGetsWhatAWholePlanGets) {
  int different = 0;
  for (const Change& change : changes()) {
    if (change.stages.empty()) continue;
    SCOPED_TRACE(change.name);
    ContourPlannerConfig want = run().header.contour_config;
    const ContourPlannerConfig have = want;
    change.make(want);
    if (stagesToRedo(have, want).empty()) continue;  // the run has it already
    StepRecord whole, part = run().record;
    plan(whole, want, StageSet::from(Stage::Contours));
    EXPECT_EQ(plan(part, want, stagesToRedo(have, want)), change.stages);
    expectSameProducts(whole, part);
    different += whole.search->segments.front().scores.front().gain !=
                 run().record.search->segments.front().scores.front().gain;
  }
  EXPECT_GT(different, 2);
}

TEST(PlanView, FromEveryStageGetsTheSame) {
  for (const Stage stage : {Stage::Contours, Stage::Surface, Stage::Segmentation, Stage::Saliency,
                            Stage::Generation, Stage::Evaluation}) {
    SCOPED_TRACE(toString(stage));
    StepRecord record = run().record;
    const std::vector<Stage> done = plan(record, run().header.contour_config, StageSet::from(stage));
    EXPECT_EQ(done.front(), stage);
    EXPECT_EQ(done.back(), Stage::Evaluation);
    expectSameProducts(run().record, record);
  }
  StepRecord untouched = run().record;
  EXPECT_TRUE(plan(untouched, run().header.contour_config, {}).empty());
  EXPECT_EQ(untouched.search, run().record.search);
}

TEST(PlanView, CancelledKeepsEarlierProductsAndNoStaleOnes) {
  const ContourPlannerConfig& config = run().header.contour_config;
  std::stop_source source;
  RunControl control;
  control.stop = source.get_token();
  StepRecord record = run().record;
  const auto stopAt = [&](Stage s) {
    if (s == Stage::Segmentation) source.request_stop();
  };
  EXPECT_THROW(
      planView(record, inputFor(config), lowViewsOnly, stopAt, control, StageSet::from(Stage::Segmentation)),
      Cancelled);
  EXPECT_EQ(record.contours, run().record.contours);
  EXPECT_EQ(record.surface, run().record.surface);
  EXPECT_TRUE(record.labels);
  EXPECT_FALSE(record.saliency);
  EXPECT_FALSE(record.positions);
  EXPECT_FALSE(record.search);

  record = run().record;  // stopped before it began
  EXPECT_THROW(planView(
                   record, inputFor(config), lowViewsOnly, [](Stage) {}, control),
               Cancelled);
  EXPECT_EQ(record.contours, run().record.contours);
  EXPECT_EQ(record.search, run().record.search);
}

TEST(PlanView, EveryStageReportsItsNameAndHowManyAreDone) {
  std::vector<std::string> phases;
  RunControl control;
  control.progress = [&](std::string_view phase, std::uint64_t done, std::uint64_t total) {
    if (phase != "score poses")
      phases.push_back(std::string(phase) + " " + std::to_string(done) + "/" + std::to_string(total));
  };
  StepRecord record;
  planView(
      record, inputFor(run().header.contour_config), lowViewsOnly, [](Stage) {}, control);
  EXPECT_THAT(phases, ElementsAre("contours 0/6", "surface 1/6", "segmentation 2/6", "saliency 3/6",
                                  "generation 4/6"));
}

TEST(PlanView, SaysWhichProductIsMissing) {
  StepRecord record = run().record;
  record.saliency.reset();
  try {
    plan(record, run().header.contour_config, StageSet::from(Stage::Generation));
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_EQ(std::string(e.what()),
              "planning again: the record has no saliency to start from; do saliency again too");
  }
  EXPECT_TRUE(record.search);  // nothing was dropped
}

/// B_th, threshold and margin of a recorded step, from what it kept.
TEST(SearchAgainOfAStep, EqualsPlanningItAfresh) {
  const ContourPlannerConfig have = run().header.contour_config;
  const StepRecord& record = run().record;
  ScoredGroups groups(*record.search, have);
  Saliency saliency = *record.saliency;
  const ViewSearchInput input{.states = run().states,
                              .camera = run().header.camera,
                              .workspace = run().header.workspace,
                              .points = record.contours->points,
                              .positions = *record.positions,
                              .point_labels = *record.point_labels,
                              .saliency = saliency,
                              .executed = {},
                              .disappointing = {}};
  for (const std::uint32_t s : groups.pendingIn(*record.search))
    groups.add(scoreGroup(input, have, record.search->segments[s], {}));
  std::vector<std::int32_t> first;
  for (const double b_th_m : {0.005, 0.01, 0.02, 0.04, 0.07, 0.1})
    for (const double margin_m : {0.0, 0.05, 0.2, 0.5}) {
      SCOPED_TRACE(b_th_m);
      SCOPED_TRACE(margin_m);
      ContourPlannerConfig want = have;
      want.saliency.isolation_distance_m = b_th_m;
      want.gain.sphere_margin_m = margin_m;
      want.gain.gain_threshold = 2000 * margin_m;
      ASSERT_TRUE(stagesToRedo(have, want).empty());
      StepRecord fresh;
      plan(fresh, want, StageSet::from(Stage::Contours));
      saliency.segments = rescoreSegments(*record.saliency, *record.labels, want.saliency);
      SearchAgain again = searchAgain(input, want, groups, lowViewsOnly);
      ASSERT_FALSE(again.pending);
      if (again.search.chosen)
        again.search.chosen->gain_voxels =
            countVoxels(input, want, again.search.segments[again.search.chosen->search],
                        again.search.chosen->T_world_camera);
      expectSameSearch(*fresh.search, again.search);
      first.push_back(again.search.segments.front().segment);
    }
  EXPECT_GT(std::set<std::int32_t>(first.begin(), first.end()).size(), 1u) << "B_th never changed the order";
}

TEST(PlanUtility, EvaluatesTheRecordedCandidatesAgain) {
  const test::SyntheticOctreeRun octree = test::makeSyntheticOctreeRun();
  HierarchicalPlannerConfig want = octree.header.octree->planner;
  want.body_m = 0.02;
  const ScanPose extra{lookAt({0.1, -0.6, 0.4}, {0.0, 0.0, 0.1}), 7};
  const std::vector<ScanPose> recorded{extra};
  const Pose current = octree.record.scan.back().T_world_camera;
  const PlanUtilityInput input{.pyramid = octree.pyramid,
                               .tree = octree.tree,
                               .object_box = octree.header.octree->object_box,
                               .workspace = octree.header.workspace,
                               .recorded = recorded,
                               .current = current,
                               .config = want};
  StepRecord whole, part;
  planUtility(whole, input, lowViewsOnly, [](Stage) {}, {});
  part = whole;
  std::vector<Stage> published;
  planUtility(
      part, input, lowViewsOnly, [&](Stage s) { published.push_back(s); }, {},
      StageSet::from(Stage::Evaluation));
  EXPECT_THAT(published, ElementsAre(Stage::Evaluation));
  ASSERT_EQ(part.utilities->views.size(), whole.utilities->views.size());
  EXPECT_EQ(part.utilities->views.back().frame, 7);
  EXPECT_EQ(part.utilities->ranking, whole.utilities->ranking);
  EXPECT_EQ(part.utilities->chosen.has_value(), whole.utilities->chosen.has_value());
  StepRecord empty;
  EXPECT_THROW(planUtility(
                   empty, input, lowViewsOnly, [](Stage) {}, {}, StageSet::from(Stage::Evaluation)),
               std::invalid_argument);
}

/// A room with a wall in the middle that one side cannot leave.
struct Room {
  StateGrid states = makeStates();
  FreeFlyerPlanner planner = makePlanner(states);
  ExplorationConfig exploration;
  RobotState start = {lookAt({-0.5, 0.0, 0.5}, {0.0, 0.0, 0.5}), {}};
  Pose beside = lookAt({-0.5, 0.4, 0.5}, {0.0, 0.0, 0.5});
  Pose beyond = lookAt({0.5, 0.0, 0.5}, {0.0, 0.0, 0.5});
  Pose inside = lookAt({0.0, 0.0, 0.5}, {1.0, 0.0, 0.5});

  StepReach reach() const {
    return {.planner = planner, .exploration = exploration, .step = 1, .start = start, .left = {}};
  }
  static FreeFlyerPlanner makePlanner(const StateGrid& states) {
    FreeFlyerConfig robot;
    robot.reach_m = 0.0;
    FreeFlyerPlanner planner(robot);
    planner.observe(states);
    return planner;
  }
  static StateGrid makeStates() {
    StateGrid grid(GridGeometry{{-0.99, -0.99, 0.01}, 0.02, {100, 100, 50}});
    for (std::size_t n = 0; n < grid.geometry().count(); ++n) {
      const Eigen::Vector3i v = grid.geometry().voxel(n);
      grid.set(v, v.x() >= 48 && v.x() < 52 ? VoxelState::Occupied : VoxelState::Free);
    }
    return grid;
  }
};

TEST(StepReach, PlansAPathFromTheStart) {
  const Room room;
  MotionPlan reported;
  const ReachPose reach = stepReach(room.reach(), reported);
  const MotionPlan found = reach(room.beside);
  EXPECT_EQ(found.verdict, Reachability::Reachable);
  EXPECT_GE(found.waypoints.size(), 2u);
  EXPECT_EQ(reach(room.inside).verdict, Reachability::InCollision);
  EXPECT_EQ(reach(room.beyond).verdict, Reachability::NotConnected);
  StepReach map_alone = room.reach();
  map_alone.start.reset();
  EXPECT_EQ(stepReach(map_alone, reported)(room.beyond).verdict, Reachability::Reachable);
  EXPECT_EQ(reported.verdict, Reachability::NotChecked);
}

TEST(StepReach, OnlyReportsWhereObstaclesAreNotEnforced) {
  Room room;
  room.exploration.enforce_reachability = false;
  MotionPlan reported;
  EXPECT_EQ(stepReach(room.reach(), reported)(room.beyond).verdict, Reachability::Reachable);
  EXPECT_EQ(reported.verdict, Reachability::NotConnected);
  EXPECT_EQ(quickReach(room.reach(), {})(room.inside).verdict, Reachability::Reachable);
}

TEST(StepReach, AReplayServesWhatItsFramesShow) {
  Room room;
  room.exploration.serve_distance_m = 0.1;
  StepReach replay = room.reach();
  replay.left = std::vector<ScanPose>{{room.beside, 3}};
  MotionPlan reported;
  EXPECT_EQ(stepReach(replay, reported)(room.beside).verdict, Reachability::Reachable);
  EXPECT_EQ(stepReach(replay, reported)(room.start.T_world_camera).verdict, Reachability::NoFrame);
  EXPECT_EQ(quickReach(replay, {})(room.start.T_world_camera).verdict, Reachability::NoFrame);
}

TEST(QuickReach, TakesTheStepsVerdictsAndElsewhereOnlyFits) {
  const Room room;
  EXPECT_EQ(quickReach(room.reach(), {})(room.beyond).verdict, Reachability::Reachable);  // no path asked for
  EXPECT_EQ(quickReach(room.reach(), {})(room.inside).verdict, Reachability::InCollision);

  StepRecord record;
  record.positions = std::make_shared<const std::vector<ViewPosition>>(
      std::vector<ViewPosition>{{0, 0, room.beyond}, {2, 0, room.beside}});
  auto search = std::make_shared<ViewSearch>();
  SegmentSearch& group = search->segments.emplace_back();
  group.scores.resize(4);
  for (std::uint32_t n = 0; n < 4; ++n) group.scores[n].id = n;
  group.scores[1].reachability = Reachability::NotConnected;  // roll 1 of the first position
  group.scores[2].reachability = Reachability::TimedOut;
  record.search = search;
  const PositionVerdicts known(record, 2);
  EXPECT_EQ(known.of(room.beyond.translation()), Reachability::NotConnected);
  EXPECT_EQ(known.of(room.beside.translation()), std::nullopt);
  EXPECT_EQ(quickReach(room.reach(), known)(room.beyond).verdict, Reachability::NotConnected);
  EXPECT_EQ(quickReach(room.reach(), known)(room.beside).verdict, Reachability::Reachable);

  StepRecord octree;
  auto utilities = std::make_shared<UtilitySearch>();
  utilities->views.resize(1);
  utilities->views[0].T_world_camera = room.beside;
  utilities->views[0].reachability = Reachability::NoPath;
  octree.utilities = utilities;
  EXPECT_EQ(quickReach(room.reach(), PositionVerdicts(octree, 8))(room.beside).verdict, Reachability::NoPath);
}

}  // namespace
}  // namespace vantage
