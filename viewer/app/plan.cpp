#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/exploration/plan_view.h"
#include "io/json_summary.h"
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
/// sensor only has to fit. Where verdicts are only reported, the last one is kept in `reported`.
ReachPose makeReach(const CollisionGrid& grid, const LoadedMap& map, MotionPlan& reported) {
  std::optional<Pose> start;
  if (map.record && !map.record->scan.empty()) start = map.record->scan.back().T_world_camera;
  return [&grid, &reported, start, step = map.step, flyer = map.settings.free_flyer,
          seed = map.settings.exploration.seed, enforce = map.settings.exploration.enforce_reachability,
          tried = std::uint64_t{0}](const Pose& pose) mutable {
    MotionPlan plan;
    if (start)
      plan = planPath(grid, *start, pose, flyer, pathSeed(seed, step, tried++));
    else
      plan.verdict = checkPosition(grid, pose.translation(), flyer);
    return judged(std::move(plan), enforce, reported);
  };
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

int plan(const GlobalOptions& global, const PlanOptions& options) {
  requireDistinctFiles({{"MAP", options.map}, {"-o", options.output}, {"--json", global.json}});
  LoadedMap map = loadMap(global, options.map);
  Settings& settings = map.settings;
  if (!options.planner.empty())
    applyAssignment(settings, fmt::format("exploration.planner={}", options.planner), "--planner");
  settings.validate();
  const StateGrid states = makeStateGrid(map.volume);
  const CollisionGrid collision(states, settings.free_flyer.cell_m, settings.free_flyer.body_radius_m);

  StepRecord record;
  record.step = map.step;
  record.planner = settings.planner();
  record.metrics.unknown_voxels = states.count(VoxelState::Unknown, settings.exploration.workspace);
  const PlanViewInput input{.volume = map.volume,
                            .states = states,
                            .camera = settings.camera,
                            .workspace = settings.exploration.workspace,
                            .config = settings.exploration.contour,
                            .executed = map.exclusions.executed,
                            .disappointing = map.exclusions.disappointing};
  MotionPlan reported;
  Console console(global);
  planView(
      record, input, makeReach(collision, map, reported),
      [&](Stage stage) {
        record.stage = stage;
        logDetail(stageText(record));
      },
      console.control());
  if (!settings.exploration.enforce_reachability) reportMotion(record, reported);
  record.stage = Stage::Done;
  console.clear();
  if (options.output != "-" && global.json != "-") say(global, stepText(record));
  if (!options.output.empty())
    writePlan(options.output, rankedViews(record, settings.exploration.contour.views));
  writeJson(global.json, nlohmann::ordered_json::parse(stepJsonText(record)));
  return 0;
}

}  // namespace

void addPlan(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto o = std::make_shared<PlanOptions>();
  CLI::App* command = app.add_subcommand("plan", "One next best view for a map");
  command->add_option("map", o->map, "TSDF (.vti) or RUN#STEP")->required()->type_name("MAP");
  command->add_option("--planner", o->planner, "How the view is chosen")->check(isPlanner());
  command
      ->add_option("-o,--output", o->output, "All scored views in the order in which they were ranked, CSV")
      ->type_name("PLAN.csv");
  command->footer("Example: vantage plan map.vti -o plan.csv --set gain.threshold=1000");
  command->callback([&global, &action, o] { action = [&global, o] { return plan(global, *o); }; });
}

}  // namespace vantage::app
