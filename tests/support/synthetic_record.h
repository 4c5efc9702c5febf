#pragma once

#include "core/exploration/step_record.h"
#include "core/volume/state_grid.h"
#include "io/run_file.h"
#include "viewer/scene_frame.h"

namespace vantage::test {

/// A small run made by the real stages: a ball and a box on a table in a wide room, seen from -y by an ideal
/// camera, in a volume of 1 cm voxels. Views above 0.45 m are declared out of reach.
struct SyntheticRun {
  RunHeader header;
  TsdfVolume volume;
  StateGrid states;
  StepRecord record;              ///< step 1, complete
  std::vector<TsdfBrick> bricks;  ///< of the first scan
  SceneFrame frame() const { return {header, record, states, &header.truth, nullptr, nullptr}; }
};

/// The same scene and frames in the octree of the hierarchical planner: voxels of 1 cm, the object's box
/// about ball and block, views on a sphere of 0.6 m or in the workspace.
struct SyntheticOctreeRun {
  RunHeader header;
  OccupancyOctree octree;
  StatePyramid pyramid;
  RayTree tree;
  StepRecord record;  ///< step 1, complete
  SceneFrame frame() const { return {header, record, pyramid.finest(), &header.truth, &pyramid, &tree}; }
};

/// \param with_views false: no view sees enough, none is chosen.
SyntheticOctreeRun makeSyntheticOctreeRun(CandidateGenerator generator = CandidateGenerator::Icosphere,
                                          bool with_views = true);

/// \param with_views false: the gain threshold is out of every view's reach, none is chosen.
SyntheticRun makeSyntheticRun(bool with_views = true);

/// A run in which nothing was recorded yet: unknown everywhere, no products.
SyntheticRun makeEmptyRun();

/// Depth of the scene from a pose, metres along z; everything else is a wall 3 m away.
DepthImage syntheticDepth(const PinholeCamera& camera, const Pose& T_world_camera);

}  // namespace vantage::test
