#include "tests/support/recorded_run.h"

#include "io/run_file.h"
#include "io/scene_file.h"
#include "tests/support/simulated_run.h"

namespace vantage::testing {
namespace {

RunHeader headerOf(const SceneFile& scene, const Settings& settings) {
  const ExplorationConfig& config = settings.exploration;
  RunHeader header;
  header.input = scene.name;
  header.planner = settings.planner();
  header.robot = "free";
  header.command_line = "recorded for a test";
  header.version = "test";
  header.scene_toml = scene.text;
  header.config_toml = effectiveToml(settings);
  header.seed = config.seed;
  header.threads = 2;
  header.camera = settings.camera;
  header.volume = config.volume;
  header.workspace = config.workspace;
  header.contour_config = config.contour;
  if (config.needsOctree())
    header.octree = OctreeHeader{config.hierarchical, config.octree, config.objectBox()};
  header.free_flyer = settings.free_flyer;
  header.truth = sceneMesh(scene, false);
  return header;
}

}  // namespace

std::filesystem::path ballScene() {
  return std::filesystem::path(VANTAGE_SOURCE_DIR) / "tests/support/ball_between_blocks.toml";
}

void recordRun(const std::filesystem::path& scene, const std::vector<std::string>& assignments,
               const std::filesystem::path& run, const std::function<void(const StepRecord&)>& written) {
  const Settings settings = sceneSettings(scene.string(), assignments);
  RunWriter writer(run, headerOf(loadScene(scene.string()), settings));
  const SimulatedRun done =
      exploreScene(scene.string(), settings, 2, [&](const StepRecord& record, const WorldModel&) {
        if (record.stage == Stage::Realised) writer.setRealised(record);
        if (record.stage != Stage::Done) return;
        writer.write(record);
        written(record);
      });
  writer.finish(done.stop_reason);
}

}  // namespace vantage::testing
