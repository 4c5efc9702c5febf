#pragma once

#include <string>

#include "io/scene_file.h"

namespace vantage::experiments {

/// Which axis of a mesh points up.
enum class UpAxis { X, Y, Z };

/// What stands on the table of an experiment.
struct ObjectSource {
  std::string name;                  ///< for tables
  std::string scene = "a1_compact";  ///< embedded scene; gives room, table and configuration
  std::string mesh;                  ///< file that takes the place of the scene's object; empty = that object
  UpAxis up = UpAxis::Z;
};

/// Stand-ins that need no file: one compact with concavities, one elongated that hides parts of itself.
ObjectSource compactStandIn();
ObjectSource elongatedStandIn();
/// A mesh file, named after it.
ObjectSource meshObject(const std::string& file, UpAxis up);

/// The source's scene with its object scaled evenly to `largest_extent_m` and put on the middle of the table.
/// \throws InputError if a mesh cannot be read or has no extent, or if there is no embedded scene of the
/// name.
SceneFile sceneOnTable(const ObjectSource& source, double largest_extent_m);

/// Bounding box of the solids whose role is `object`.
Box objectBounds(const SceneFile& scene);
/// Height of the upper face of the highest table solid, metres. \throws InputError if there is none.
double tableTop_m(const SceneFile& scene);

}  // namespace vantage::experiments
