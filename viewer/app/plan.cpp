#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "core/exploration/plan_view.h"
#include "core/exploration/replan.h"
#include "core/geometry/check.h"
#include "io/json_summary.h"
#include "io/run_robot.h"
#include "io/table_file.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/inputs.h"
#include "viewer/app/json_output.h"
#include "viewer/app/step_text.h"

namespace vantage::app {
namespace {

struct PlanOptions {
  std::string map, planner, output;
};

/// Reachability without a robot: from the pose of a recorded step a path is planned; for a map alone the
/// sensor only has to fit. A replay offers what its recording can serve.
ReachPose makeReach(const MotionPlanner& motion, const LoadedMap& map, MotionPlan& reported) {
  StepReach reach{
      .planner = motion, .exploration = map.settings.exploration, .step = map.step, .start = {}, .left = {}};
  if (map.record && !map.record->scan.empty()) reach.start = stateAfterScan(*map.record);
  if (!map.recording.empty() && map.settings.exploration.serve_distance_m > 0.0) reach.left = posesLeft(map);
  return stepReach(std::move(reach), reported);
}

/// The run's robot, else the free flyer, in the map.
std::shared_ptr<MotionPlanner> motionIn(const LoadedMap& map, const StateGrid& states) {
  auto motion = map.motion ? map.motion : std::make_shared<FreeFlyerPlanner>(map.settings.free_flyer);
  motion->observe(states);
  return motion;
}

std::vector<PlanRow> rankedViews(const StepRecord& record, const ContourViewConfig& views) {
  std::vector<PlanRow> rows;
  for (const SegmentSearch& search : record.search->segments)
    for (const PoseScore& score : search.scores) {
      const ViewPosition& position = (*record.positions)[score.id / views.rolls];
      PlanRow row;
      row.view = {score.id, rolledPose(position, static_cast<int>(score.id) % views.rolls, views),
                  position.group};
      row.segment = search.segment >= 0 ? record.saliency->segments[search.segment].label : 0;
      row.saliency = search.saliency;
      row.gain = score.gain;
      row.reachability = tokenOf(score.reachability);
      row.chosen = record.hasView() && record.chosen()->id == score.id;
      rows.push_back(row);
    }
  return rows;
}

/// The planner that is asked for, else that of the recorded step, else the one that works on the map.
PlannerKind plannerFor(const LoadedMap& map, const PlanOptions& options) {
  const PlannerKind configured = map.settings.exploration.plannerOf(map.step);
  if (!options.planner.empty() || map.record) return configured;
  return map.hasVolume() ? configured : PlannerKind::Hierarchical;
}

void requireMapFor(PlannerKind kind, const LoadedMap& map, const PlanOptions& options) {
  if (usesOctree(kind) ? map.octree.has_value() : map.hasVolume()) return;
  throw InputError(options.map,
                   usesOctree(kind)
                       ? "holds no octree, which this planner works on; give a .bt or .ot file or a run "
                         "of the hierarchical planner"
                       : "holds no TSDF, which this planner works on; give a .vti file or a run of the "
                         "contour planner");
}

using Publish = std::function<void(Stage)>;

void planContour(const LoadedMap& map, PlannerKind kind, StepRecord& record, MotionPlan& reported,
                 const Publish& publish, const RunControl& control) {
  const ExplorationConfig& config = map.settings.exploration;
  ContourPlannerConfig planner = config.contour;
  planner.segment_by_segment = kind == PlannerKind::Contour;
  requireCollisionCell(map.settings, map.volume.geometry().voxel_size_m);
  const StateGrid states = makeStateGrid(map.volume);
  const auto motion = motionIn(map, states);
  const PlanViewInput input{.volume = map.volume,
                            .states = states,
                            .camera = map.settings.camera,
                            .workspace = config.workspace,
                            .config = planner,
                            .executed = map.exclusions.executed,
                            .disappointing = map.exclusions.disappointing};
  record.metrics.unknown_voxels = states.count(VoxelState::Unknown, config.workspace);
  planView(record, input, makeReach(*motion, map, reported), publish, control);
}

void planOctree(const LoadedMap& map, PlannerKind kind, StepRecord& record, MotionPlan& reported,
                const Publish& publish, const RunControl& control) {
  const ExplorationConfig& config = map.settings.exploration;
  HierarchicalPlannerConfig planner = config.hierarchical;
  if (kind == PlannerKind::Uniform) planner.coarse_levels = 0;
  const double voxel_m = map.octree->geometry().voxel_size_m;
  requireInRange("rays.coarse_levels", planner.coarse_levels, 0, maxCoarseLevels(planner.sensor, voxel_m));
  requireCollisionCell(map.settings, voxel_m);
  const Box object_box = objectBoxOf(map), workspace = mappedBox(map);
  const StatePyramid pyramid(*map.octree, planner.coarse_levels);
  const RayTree tree(planner.sensor, voxel_m, planner.coarse_levels);
  const auto motion = motionIn(map, pyramid.finest());
  const bool on_step = map.record && !map.record->scan.empty();
  const Pose current = on_step ? map.record->scan.back().T_world_camera
                               : makePose(object_box.center(), Eigen::Quaterniond::Identity());
  if (!on_step) planner.rotation_weight_m_per_rad = 0.0;  // no current pose: turning costs nothing
  const std::vector<ScanPose> recorded =
      config.recorded_candidates ? posesLeft(map) : std::vector<ScanPose>();
  const PlanUtilityInput input{.pyramid = pyramid,
                               .tree = tree,
                               .object_box = object_box,
                               .workspace = workspace,
                               .recorded = recorded,
                               .current = current,
                               .config = planner,
                               .executed = map.exclusions.executed,
                               .seed = pathSeed(config.seed, record.step, 0)};
  const StateGrid& states = pyramid.finest();
  record.metrics.unknown_voxels =
      states.count(VoxelState::Unknown, map.record ? config.workspace : workspace);
  record.box = std::make_shared<BoxMetrics>(BoxMetrics{states.count(VoxelState::Unknown, object_box),
                                                       states.count(VoxelState::Occupied, object_box)});
  planUtility(record, input, makeReach(*motion, map, reported), publish, control);
}

int plan(const GlobalOptions& global, const PlanOptions& options) {
  requireDistinctFiles({{"MAP", options.map}, {"-o", options.output}, {"--json", global.json}});
  LoadedMap map = loadMap(global, options.map, MapNeed::Either);
  Settings& settings = map.settings;
  if (options.planner.find(',') != std::string::npos)
    throw InputError("--planner " + options.planner,
                     "names several planners, and one view is planned; name one of them");
  if (!options.planner.empty())
    applyAssignment(settings, fmt::format("exploration.planner={}", options.planner), "--planner");
  settings.validate();
  const PlannerKind kind = plannerFor(map, options);
  requireMapFor(kind, map, options);

  StepRecord record;
  record.step = map.step;
  record.planner = toString(kind);
  MotionPlan reported;
  Console console(global);
  const Publish publish = [&](Stage stage) {
    record.stage = stage;
    logDetail(stageText(record));
  };
  if (usesOctree(kind))
    planOctree(map, kind, record, reported, publish, console.control());
  else
    planContour(map, kind, record, reported, publish, console.control());
  if (!settings.exploration.enforce_reachability) reportMotion(record, reported);
  record.stage = Stage::Done;
  console.clear();
  if (options.output != "-" && global.json != "-")
    say(global, stepText(record, settings.exploration.hierarchical.stop_gain));
  if (!options.output.empty()) {
    if (record.utilities)
      writeUtilities(options.output, *record.utilities);
    else
      writePlan(options.output, rankedViews(record, settings.exploration.contour.views));
  }
  writeJson(global.json, nlohmann::ordered_json::parse(stepJsonText(record)));
  return 0;
}

}  // namespace

void addPlan(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto o = std::make_shared<PlanOptions>();
  CLI::App* command = app.add_subcommand("plan", "One next best view for a map");
  command->add_option("map", o->map, "TSDF (.vti), octree (.bt, .ot) or RUN#STEP")
      ->required()
      ->type_name("MAP");
  command->add_option("--planner", o->planner, "How the view is chosen")->check(isPlanner());
  command
      ->add_option("-o,--output", o->output, "All scored views in the order in which they were ranked, CSV")
      ->type_name("PLAN.csv");
  command->footer("Example: vantage plan map.vti -o plan.csv --set gain.threshold=1000");
  command->callback([&global, &action, o] { action = [&global, o] { return plan(global, *o); }; });
}

}  // namespace vantage::app
