#include "io/json_summary.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "io/error.h"
#include "tests/io/run_support.h"

namespace vantage::testing {
namespace {

using Json = nlohmann::ordered_json;
using Keys = std::vector<std::string>;

Keys keysOf(const Json& object) {
  Keys keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

const Keys kRun = {"version", "input",   "planner",     "robot", "seed",
                   "threads", "compute", "stop_reason", "steps", "final"};
const Keys kStep = {"step",
                    "status",
                    "position_m",
                    "quaternion_xyzw",
                    "gain",
                    "gain_voxels",
                    "realised_voxels",
                    "poses_generated",
                    "poses_scored",
                    "poses_unreachable",
                    "rays",
                    "voxels_visited",
                    "unknown_voxels",
                    "coverage",
                    "timings_s",
                    "segment",
                    "saliency",
                    "toward_object",
                    "unknown_near_objects",
                    "unknown_in_boxes",
                    "planner",
                    "rejected_position",
                    "rejected_registration",
                    "occupied",
                    "distance",
                    "utility",
                    "literal_stop",
                    "box_unknown",
                    "box_occupied"};
const Keys kTimings = {"sense",           "filter",   "fuse",       "contours",   "surface",
                       "segmentation",    "saliency", "generation", "evaluation", "collision_map",
                       "motion_planning", "motion"};

RunHeader header(bool replay) {
  RunHeader h = randomHeader(3);
  h.replay = replay;
  return h;
}

TEST(JsonSummary, HasEveryKeyOfTheContractInOrder) {
  JsonSummary summary(header(false));
  summary.add(randomRecord(1, 1));
  StepRecord none;
  none.step = 2;
  summary.add(none);
  const Json json = Json::parse(summary.text());
  EXPECT_EQ(keysOf(json), kRun);
  ASSERT_EQ(json["steps"].size(), 2u);
  for (const Json& step : json["steps"]) {
    EXPECT_EQ(keysOf(step), kStep);
    EXPECT_EQ(keysOf(step["timings_s"]), kTimings);
  }
}

TEST(JsonSummary, DataSetsAlsoNameTheFrameThatServed) {
  JsonSummary summary(header(true));
  StepRecord record = randomRecord(1, 1);
  record.served.reset();
  summary.add(record);
  Keys keys = kStep;
  keys.insert(keys.end(), {"frame", "served_position_m", "served_quaternion_xyzw"});
  Json step = Json::parse(summary.text())["steps"][0];
  EXPECT_EQ(keysOf(step), keys);
  EXPECT_TRUE(step["frame"].is_null());

  record.served = ScanPose{makePose({1, 2, 3}, {0, 0, 0, -1}), 17};
  record.realised_voxels = 5;
  summary.setRealised(record);
  step = Json::parse(summary.text())["steps"][0];
  EXPECT_EQ(keysOf(step), keys);
  EXPECT_EQ(step["frame"], 17);
  EXPECT_EQ(step["realised_voxels"], 5);
  EXPECT_EQ(step["served_position_m"], (Json{1.0, 2.0, 3.0}));
  EXPECT_EQ(step["served_quaternion_xyzw"].size(), 4u);
  record.step = 8;
  EXPECT_THROW(summary.setRealised(record), std::invalid_argument);
}

TEST(JsonSummary, CarriesTheValuesOfTheRecord) {
  StepRecord record = randomRecord(1, 1);
  auto search = std::make_shared<ViewSearch>(*record.search);
  search->chosen->T_world_camera = makePose({0.25, -1, 3}, Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5));
  search->chosen->search = 1;
  search->segments[1].segment = 2;
  record.search = search;
  record.timings.filter.reset();
  record.metrics.coverage = 0.75;
  JsonSummary summary(header(false));
  summary.add(record);
  const Json step = Json::parse(summary.text())["steps"][0];
  EXPECT_EQ(step["status"], "view");
  EXPECT_EQ(step["position_m"], (Json{0.25, -1.0, 3.0}));
  const double expected[] = {-0.5, 0.5, 0.5, 0.5};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(step["quaternion_xyzw"][i].get<double>(), expected[i], 1e-12);
  EXPECT_EQ(step["gain"], search->chosen->gain);
  EXPECT_EQ(step["gain_voxels"], search->chosen->gain_voxels);
  EXPECT_EQ(step["realised_voxels"], *record.realised_voxels);
  EXPECT_EQ(step["poses_unreachable"], search->counts.poses_unreachable);
  EXPECT_EQ(step["voxels_visited"], search->counts.voxels_visited);
  EXPECT_EQ(step["segment"], record.saliency->segments[2].label);
  EXPECT_EQ(step["saliency"], search->segments[1].saliency);
  EXPECT_EQ(step["toward_object"], *record.toward_object);
  EXPECT_EQ(step["coverage"], 0.75);
  EXPECT_EQ(step["timings_s"]["fuse"], *record.timings.fuse);
  EXPECT_TRUE(step["timings_s"]["filter"].is_null());
}

TEST(JsonSummary, PointsWithoutASegmentAreSegmentZeroAndTheBaselineHasNone) {
  StepRecord record = randomRecord(1, 1);
  auto search = std::make_shared<ViewSearch>(*record.search);
  search->segments[search->chosen->search].segment = -1;
  record.search = search;
  JsonSummary summary(header(false));
  summary.add(record);
  record.saliency.reset();
  record.step = 2;
  summary.add(record);
  const Json json = Json::parse(summary.text());
  EXPECT_EQ(json["steps"][0]["segment"], 0);
  EXPECT_TRUE(json["steps"][1]["segment"].is_null());
  EXPECT_TRUE(json["steps"][1]["saliency"].is_null());
}

TEST(JsonSummary, CarriesTheFactorsOfTheHierarchicalPlanner) {
  StepRecord record;
  record.planner = "hierarchical";
  UtilitySearch search;
  search.rejected_position = 3;
  search.rejected_registration = 2;
  search.counts.rays = 77;
  search.views.resize(1);
  search.views[0].id = 9;
  search.views[0].occupied = 450;
  search.views[0].distance = 0.5;
  search.views[0].utility = 0.125;
  search.ranking = {0};
  search.chosen.emplace();
  search.chosen->id = 9;
  search.chosen->gain = 1234;
  record.utilities = std::make_shared<UtilitySearch>(search);
  record.box = std::make_shared<BoxMetrics>(BoxMetrics{500, 60});
  JsonSummary summary(header(false));
  summary.add(record);
  const Json step = Json::parse(summary.text())["steps"][0];
  EXPECT_EQ(step["status"], "view");
  EXPECT_EQ(step["planner"], "hierarchical");
  EXPECT_EQ(step["gain"], 1234.0);
  EXPECT_EQ(step["rays"], 77u);
  EXPECT_EQ(step["rejected_position"], 3u);
  EXPECT_EQ(step["rejected_registration"], 2u);
  EXPECT_EQ(step["occupied"], 450.0);
  EXPECT_EQ(step["distance"], 0.5);
  EXPECT_EQ(step["utility"], 0.125);
  EXPECT_EQ(step["box_unknown"], 500u);
  EXPECT_EQ(step["box_occupied"], 60u);
  EXPECT_TRUE(step["segment"].is_null());
}

TEST(JsonSummary, AStepWithoutAViewIsNoneWithNulls) {
  StepRecord record = randomRecord(1, 1);
  auto search = std::make_shared<ViewSearch>(*record.search);
  search->chosen.reset();
  record.search = search;
  record.utilities.reset();
  record.realised_voxels.reset();
  record.toward_object.reset();
  JsonSummary summary(header(false));
  summary.add(record);
  const Json step = Json::parse(summary.text())["steps"][0];
  EXPECT_EQ(step["status"], "none");
  for (const char* key : {"position_m", "quaternion_xyzw", "gain", "gain_voxels", "realised_voxels",
                          "segment", "saliency", "toward_object"})
    EXPECT_TRUE(step[key].is_null()) << key;
  EXPECT_EQ(step["poses_generated"], search->counts.poses_generated);
}

TEST(JsonSummary, FromARunFileEqualsTheLiveOne) {
  const TestFolder folder;
  for (const bool replay : {false, true}) {
    JsonSummary live(header(replay));
    {
      RunWriter writer(folder / "a.vantage", header(replay));
      for (int step = 1; step <= 3; ++step) {
        StepRecord record = randomRecord(step, step);
        record.realised_voxels.reset();
        record.served.reset();
        writer.write(record);
        live.add(record);
        record.stage = Stage::Realised;
        record.realised_voxels = 1000 + step;
        record.served = ScanPose{lookAt({1, 2, 3}, {0, 0, 0}), step};
        writer.setRealised(record);
        live.setRealised(record);
      }
      writer.write(randomRecord(4, 4, true));
      live.add(randomRecord(4, 4, true));
      writer.finish("steps done");
      live.finish("steps done");
    }
    const std::string recorded = jsonSummary(RunReader(folder / "a.vantage"))->text();
    EXPECT_EQ(recorded, live.text());
    const Json json = Json::parse(recorded);
    EXPECT_EQ(json["stop_reason"], "steps done");
    EXPECT_EQ(keysOf(json["final"]), (Keys{"unknown_voxels", "coverage", "unknown_near_objects",
                                           "unknown_in_boxes", "box_unknown", "box_occupied"}));
    EXPECT_EQ(json["final"]["unknown_voxels"], randomRecord(4, 4, true).metrics.unknown_voxels);
  }
}

TEST(JsonSummary, ARunGoingOnHasNoStopReason) {
  const Json json = Json::parse(JsonSummary(header(false)).text());
  EXPECT_TRUE(json["stop_reason"].is_null());
  EXPECT_TRUE(json["final"].is_null());
  EXPECT_TRUE(json["steps"].empty());
}

TEST(JsonSummary, WritesAFileOrSaysWhyNot) {
  const TestFolder folder;
  JsonSummary summary(header(false));
  summary.add(randomRecord(1, 1));
  summary.write((folder / "a.json").string());
  std::ifstream file(folder / "a.json");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), summary.text());
  EXPECT_THROW(summary.write((folder / "none/a.json").string()), InputError);
}

}  // namespace
}  // namespace vantage::testing
