#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "core/exploration/explorer.h"
#include "core/gpu/egl_context.h"
#include "core/motion/arm_planner.h"
#include "io/dataset_writer.h"
#include "io/json_summary.h"
#include "io/run_file.h"
#include "io/text_file.h"
#include "snapshots/snapshot.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/counted.h"
#include "viewer/app/exploration_input.h"
#include "viewer/app/inputs.h"
#include "viewer/app/step_text.h"

namespace vantage::app {
namespace {

struct ExploreOptions : ExplorationRequest {
  std::string run, snapshots;
};

RunHeader makeHeader(const GlobalOptions& global, const ExploreOptions& options,
                     const ExplorationInput& input) {
  const Settings& settings = input.settings;
  RunHeader header;
  header.input = options.input;
  header.planner = settings.planner();
  header.robot = options.robot;
  header.command_line = global.command_line;
  header.version = VANTAGE_VERSION;
  header.scene_toml = input.scene_text;
  header.config_toml = effectiveToml(settings);
  header.seed = settings.exploration.seed;
  header.threads = threadsInUse();
  header.camera = input.camera->model();
  header.volume = settings.exploration.volume;
  header.workspace = settings.exploration.workspace;
  header.contour_config = settings.exploration.contour;
  if (settings.exploration.needsOctree())
    header.octree = OctreeHeader{settings.exploration.hierarchical, settings.exploration.octree,
                                 settings.exploration.objectBox()};
  header.free_flyer = settings.free_flyer;
  header.arm = input.arm;
  header.replay = input.replay;
  header.truth = input.truth_mesh;
  return header;
}

/// What a gain counts and how (D-B11, D-B12).
std::string gainText(const GainConfig& gain) {
  const std::string rays = fmt::format("rays at 1/{} of the resolution", gain.reduction);
  switch (gain.count) {
    case GainMeasure::Rays:
      return fmt::format("gains: first-hit unknown {} x {:g}, threshold {:g} rays", rays, gain.perUnknown(),
                         gain.gain_threshold);
    case GainMeasure::Voxels:
      return fmt::format("gains: first-hit unknown voxels of {}, threshold {:g} voxels", rays,
                         gain.gain_threshold);
    case GainMeasure::Volume:
      return fmt::format("gains: unknown voxels before anything occupied, {}, threshold {:g} voxels", rays,
                         gain.gain_threshold);
  }
  return "";
}

void announce(const GlobalOptions& global, const ExploreOptions& options, const Settings& settings) {
  const ExplorationConfig& config = settings.exploration;
  const GridGeometry volume =
      config.needsVolume() ? config.volume
                           : OccupancyOctree::gridAround(config.volume.bounds(), config.octree.voxel_size_m);
  say(global, fmt::format("{}: {} planner, {} NBVs, {} x {} x {} voxels of {:.3f} mm, seed {}", options.input,
                          settings.planner(), settings.exploration.steps, volume.size.x(), volume.size.y(),
                          volume.size.z(), volume.voxel_size_m * 1e3, settings.exploration.seed));
  const GainConfig& gain = config.contour.gain;
  if (config.needsVolume()) say(global, gainText(gain));
  const HierarchicalPlannerConfig& rays = config.hierarchical;
  const bool coarse_first =
      std::ranges::find(config.planners, PlannerKind::Hierarchical) != config.planners.end();
  const std::string unit = rays.count == GainCount::Voxels ? "voxels" : "rays";
  if (config.needsOctree())
    say(global,
        fmt::format(
            "utility: {}, {} wanted, stops below {:g} {} of unknown",
            coarse_first ? counted(rays.coarse_levels, "coarse level") : "every ray at the finest voxels",
            rays.min_overlap > 0.0 ? fmt::format("{:g} % of known surface in view", rays.min_overlap * 100.0)
                                   : fmt::format("{:g} {} of known surface", rays.min_occupied, unit),
            rays.stop_gain, unit));
}

/// What the planners could not work with is said before a run file is made.
void checkMaps(const ExplorationConfig& config, const Settings& settings) {
  if (config.needsVolume()) requireCollisionCell(settings, config.volume.voxel_size_m);
  if (!config.needsOctree()) return;
  requireCollisionCell(settings, config.octree.voxel_size_m);
  if (!overlap(config.objectBox(), config.volume.bounds()))
    warn(
        "octree.object_min_m, octree.object_max_m: the object's box lies outside the mapped volume; nothing "
        "in it "
        "can be seen");
}

/// Pictures of every step, from the run file alone.
void takePictures(const GlobalOptions& global, const ExploreOptions& options, Console& console) {
  SnapshotRequest request;
  request.output = options.snapshots;
  const auto files = takeSnapshots(options.run, request, console.control());
  console.clear();
  say(global, fmt::format("{} in {}", counted(files.size(), "picture"), options.snapshots));
}

/// What cannot be written or drawn is said before the work.
void checkOutputs(const GlobalOptions& global, const ExploreOptions& options) {
  if (options.run == "-") throw InputError("-o -", "a run cannot be streamed; give a file name");
  requireDistinctFiles({{"input", options.input},
                        {"-o", options.run},
                        {"--json", global.json},
                        {"--record", options.record},
                        {"--snapshots", options.snapshots}});
  if (!global.json.empty() && global.json != "-") requireCreatable(global.json);
  if (!options.record.empty()) requireEmptyFolder(options.record);
  if (options.snapshots.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(options.snapshots, error);
  if (!std::filesystem::is_directory(options.snapshots))
    throw InputError("--snapshots " + options.snapshots,
                     "is no folder and cannot be made one; choose another name");
  const EglContext probe;
}

/// What a live session showed cannot be had again.
void recordLive(ExploreOptions& options) {
  if (!isDevice(options.input)) return;
  if (options.run.empty()) options.run = "live.vantage";
  if (options.record.empty())
    options.record = std::filesystem::path(options.run).replace_extension().string() + "-frames";
}

/// An arm that must not go on, or a frame that can't be recorded, ends the run; what it has is kept and
/// closed.
ExplorationResult runToEnd(Explorer& explorer, const RunControl& control) {
  int steps = 0;
  explorer.addObserver([&](const std::shared_ptr<const StepRecord>& record) {
    steps += record->stage == Stage::Done && !record->closing;
  });
  try {
    return explorer.run(control);
  } catch (const ArmRefusal& refusal) {
    return {"failed", steps, refusal.what()};
  } catch (const InputError& error) {
    return {"failed", steps, error.what()};
  }
}

int explore(const GlobalOptions& global, ExploreOptions options) {
  recordLive(options);
  checkOutputs(global, options);
  ExplorationInput input = openExplorationInput(global, options);
  if (options.run.empty()) options.run = input.name + ".vantage";
  checkMaps(input.settings.exploration, input.settings);
  Console console(global);
  announce(global, options, input.settings);

  Explorer explorer(input.settings.exploration, *input.camera, *input.robot, input.truth.get());
  const RunHeader header = makeHeader(global, options, input);
  RunWriter writer(options.run, header);
  JsonSummary json(header);
  explorer.addObserver([&](const std::shared_ptr<const StepRecord>& record) {
    logDetail(stageText(*record));
    if (record->stage == Stage::Realised) {
      writer.setRealised(*record);
      json.setRealised(*record);
      if (record->served) say(global, servedText(*record));
    }
    if (record->stage != Stage::Done) return;
    writer.write(*record);
    json.add(*record);
    console.clear();
    say(global, stepText(*record, input.settings.exploration.hierarchical.stop_gain));
  });
  const ExplorationResult result = runToEnd(explorer, console.control());
  writer.finish(result.stop_reason);
  json.finish(result.stop_reason);
  console.clear();
  say(global, fmt::format("{} after {}; recorded in {}", result.stop_reason, counted(result.steps, "step"),
                          options.run));
  if (!options.record.empty()) say(global, fmt::format("frames recorded in {}", options.record));
  if (!global.json.empty()) json.write(global.json);
  if (!result.lost.empty())
    throw std::runtime_error(
        fmt::format("{}; {} kept in {}", result.lost, counted(result.steps, "finished step"), options.run));
  if (console.interrupted())
    throw Interrupted(
        fmt::format("{}: interrupted; {} kept", options.run, counted(result.steps, "finished step")));
  if (!options.snapshots.empty()) takePictures(global, options, console);
  return 0;
}

}  // namespace

void addExplore(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto options = std::make_shared<ExploreOptions>();
  CLI::App* command =
      app.add_subcommand("explore", "Explore a scene or replay a data set: the whole loop, recorded");
  command
      ->add_option("input", options->input,
                   "Embedded scene, scene TOML, recorded RGB-D sequence (folder or .bag), or a live camera")
      ->required()
      ->type_name("SCENE|DATASET|CAMERA");
  command->add_option("-o,--output", options->run, "Run file to write (default: NAME.vantage)")
      ->type_name("RUN");
  command
      ->add_option("--planner", options->planner,
                   "How views are chosen; several with commas: one for each view, the last goes on")
      ->check(isPlanner());
  command->add_option("--steps", options->steps, "Number of next best views")
      ->check(CLI::Range(0, 100000))
      ->type_name("N");
  command
      ->add_option("--robot", options->robot,
                   "What carries the camera: free, an arm of 'vantage robots', or a URDF file")
      ->type_name("free|NAME|FILE.urdf");
  command
      ->add_option("--controller", options->controller, "Live arms: what moves the arm, of 'vantage devices'")
      ->type_name("DEVICE");
  command->add_option("--joint-states", options->joint_states, "Live arms: topic of the joints' positions")
      ->capture_default_str()
      ->type_name("TOPIC");
  command
      ->add_option("--record", options->record,
                   "New folder for all frames as a data set, depth rounded to millimetres (live: RUN-frames)")
      ->type_name("DIR");
  command->add_option("--snapshots", options->snapshots, "Folder for pictures of every step")
      ->type_name("DIR");
  command->footer("Example: vantage explore tabletop -o tabletop.vantage --snapshots pictures");
  command->callback(
      [&global, &action, options] { action = [&global, options] { return explore(global, *options); }; });
}

}  // namespace vantage::app
