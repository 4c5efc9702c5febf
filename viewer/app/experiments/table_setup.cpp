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

TableSetup setUpTable(const ObjectSource& source, double size_m, int steps,
                      const std::function<void(Settings&)>& tune) {
  TableSetup setup;
  setup.object = source.name;
  setup.size_m = size_m;
  setup.scene = sceneOnTable(source, size_m);
  setup.table_top_m = tableTop_m(setup.scene);
  applyToml(setup.settings, setup.scene.text, setup.scene.source_path, sceneGeometryKeys());
  ExplorationConfig& exploration = setup.settings.exploration;
  exploration.octree.object_box = exploration.workspace = objectBox(setup.scene);
  exploration.octree.known_solids = knownSolids(setup.scene);
  exploration.planners = {PlannerKind::Hierarchical};
  exploration.steps = steps;
  if (tune) tune(setup.settings);
  setup.settings.validate();
  const auto candidates = makeCandidates(exploration.hierarchical, exploration.objectBox(),
                                         exploration.volume.bounds(), exploration.seed);
  setup.truth = std::make_unique<CandidateTruth>(setup.scene, candidates, exploration.hierarchical.body_m);
  return setup;
}

std::string RunSpec::label() const {
  if (coarse_levels == 0) return "m=0 uniform";
  return fmt::format("m={} {}{}", coarse_levels, start == ChildStart::Resume ? "resume" : "restart",
                     inner == InnerRule::Mean ? " mean" : "");
}

}  // namespace vantage::experiments
