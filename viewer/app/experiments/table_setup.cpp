#include <fmt/format.h>

#include <cmath>

#include "viewer/app/experiments/table_run.h"

namespace vantage::experiments {

Box objectBox(const SceneFile& scene) {
  constexpr double kMargin_m = 0.05;
  Box box = objectBounds(scene);
  box.min().array() -= kMargin_m;
  box.max().array() += kMargin_m;
  // The table's top lies up to a voxel below the border from which the box begins; the border itself counts.
  box.min().z() = std::ceil(tableTop_m(scene) * 100.0 - 1e-6) / 100.0;
  return box;
}

Settings tableSettings(const SceneFile& scene, int steps, const std::function<void(Settings&)>& tune) {
  Settings settings;
  applyScene(settings, scene);
  ExplorationConfig& exploration = settings.exploration;
  exploration.octree.object_box = exploration.workspace = objectBox(scene);
  exploration.octree.known_scene = true;
  exploration.steps = steps;
  if (tune) tune(settings);
  exploration.planners = {PlannerKind::Hierarchical};  // each run has its own; no other kind can be compared
  settings.validate();
  return settings;
}

TableSetup setUpTable(const ObjectSource& source, double size_m, int steps,
                      const std::function<void(Settings&)>& tune) {
  TableSetup setup;
  setup.object = source.name;
  setup.size_m = size_m;
  setup.scene = sceneOnTable(source, size_m);
  setup.table_top_m = tableTop_m(setup.scene);
  setup.settings = tableSettings(setup.scene, steps, tune);
  const ExplorationConfig& exploration = setup.settings.exploration;
  const auto candidates = makeCandidates(exploration.hierarchical, exploration.objectBox(),
                                         exploration.volume.bounds(), exploration.seed);
  setup.truth = std::make_unique<CandidateTruth>(setup.scene, candidates, exploration.hierarchical.body_m);
  return setup;
}

std::string RunSpec::label() const {
  const char* mode = coarse_levels == 0 ? "uniform" : start == ChildStart::Resume ? "resume" : "restart";
  return fmt::format("m={} {}{}{}{}{}", coarse_levels, mode, inner == InnerRule::Mean ? " mean" : "",
                     repeat_views ? " repeats" : "",
                     min_overlap > 0 ? fmt::format(" overlap {:g} %", 100 * min_overlap) : "",
                     refine_unknown ? " refine unknown" : "");
}

}  // namespace vantage::experiments
