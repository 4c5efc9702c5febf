#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/triangle_mesh.h"
#include "io/error.h"
#include "io/solid.h"

namespace vantage {

/// A scene: named solids in world coordinates (z up, metres), read from TOML:
///
///     name = "kitchen"                    # optional, else the file's name
///     description = "one line"            # optional
///
///     [room]                              # optional: six slabs around a closed inner space
///     x_m = [-3.0, 3.0]                   # inner faces
///     y_m = [-3.0, 3.0]
///     z_m = [-0.8, 2.5]
///     thickness_m = 0.1                   # optional
///     color = "#d8d8d8"                   # optional
///
///     [[solid]]
///     kind = "box"                        # see below
///     object = "box L"                    # optional name; solids of one name form one object
///     role = "object"                     # object (default), table, panel, room, other
///     color = "#e69f00"                   # optional
///     position_m = [0.0, 0.0, 0.0]        # optional: of the solid's origin
///     yaw_deg = 30.0                      # optional, about z; or rpy_deg = [roll, pitch, yaw] (Rz Ry Rx)
///     size_m = [0.2, 0.1, 0.1]            # keys of the kind
///
/// | kind     | keys                                              | origin |
/// |----------|---------------------------------------------------|------------------------------------------|
/// | box      | size_m                                            | middle of the lower face | | sphere   |
/// radius_m                                          | centre                                   | | cylinder
/// | radius_m, height_m                                | middle of the lower disc                 | | cone |
/// radius_bottom_m, radius_top_m, height_m           | middle of the lower disc                 | | torus |
/// radius_m, tube_radius_m, angle_deg (360)          | centre; axis z, begins on x              | | lathe |
/// profile_m = [[r, z], ...], smooth (false), thickness_m (none: solid) | the axis is z         | | sweep |
/// path_m = [[x, y, z], ...], radius_m               | as the path                              | | mesh |
/// file (PLY, OBJ, STL; beside the scene file), scale (1) | as the file                         |
///
/// See makeLathe() and the other makers in solid.h for their meaning. Other top-level keys are configuration
/// (see config_file.h) and are left alone here.
struct SceneFile {
  std::string name;
  std::string description;
  std::string source_path;  ///< path, or the name of an embedded scene
  std::vector<Solid> solids;
  std::string text;  ///< the whole TOML document
};

/// Top-level keys of a scene file that belong to the geometry; all others belong to the configuration.
const std::vector<std::string>& sceneGeometryKeys();

/// Reads a scene: an embedded one by its name, otherwise a file.
/// \throws InputError `FILE:LINE: ...` for a missing or broken file, an unknown kind or geometry key, a
/// missing or
///         wrong value.
SceneFile loadScene(const std::string& name_or_path);

/// The same from TOML text. `source` names it in messages; mesh files are sought in `folder`.
SceneFile parseScene(std::string_view text, const std::string& source, const std::string& folder);

struct EmbeddedScene {
  std::string name;
  std::string description;
};
/// Scenes that are compiled into the program, by name.
std::vector<EmbeddedScene> embeddedScenes();

/// Surfaces of all solids in one mesh, with their colours; the room only if wanted.
TriangleMesh sceneMesh(const SceneFile& scene, bool include_room);

}  // namespace vantage
