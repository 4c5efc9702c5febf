#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/triangle_mesh.h"
#include "io/error.h"
#include "io/solid.h"

namespace vantage {

struct Settings;

/// Text of a scene file and its name in messages.
struct SceneLayer {
  std::string source;  ///< path, or the name of an embedded scene
  std::string text;
};

// clang-format off
/// A scene: named solids in world coordinates (z up, metres), read from TOML:
///
///     name = "kitchen"                    # optional, else the file's name
///     description = "one line"            # optional
///
///     base = "tabletop"                   # optional: an embedded scene or a file beside this one
///     without = ["panel", "ball"]         # optional: roles and objects of the base that are left out
///
///     [[move]]                            # optional: puts an object of the base elsewhere
///     object = "jug A"
///     position_m = [0.1, 0.0, 0.0]        # of its first solid; the others keep their place beside it
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
/// | kind     | keys                                                                   | origin                   |
/// |----------|------------------------------------------------------------------------|--------------------------|
/// | box      | size_m                                                                 | middle of the lower face |
/// | sphere   | radius_m                                                               | centre                   |
/// | cylinder | radius_m, height_m                                                     | middle of the lower disc |
/// | cone     | radius_bottom_m, radius_top_m, height_m                                | middle of the lower disc |
/// | torus    | radius_m, tube_radius_m, angle_deg (360)                               | centre; axis z, from x   |
/// | lathe    | profile_m = [[r, z], ...], smooth (false), thickness_m (none: solid)   | the axis is z            |
/// | sweep    | path_m = [[x, y, z], ...], radius_m                                    | as the path              |
/// | mesh     | file (PLY, OBJ, STL; beside the scene file), scale (1)                 | as the file              |
///
/// See makeLathe() and the other makers in solid.h for their meaning. The solids of a base come first, changed
/// as the file says, then its own. Other top-level keys are configuration (config_file.h): applyScene(). The
/// file's own keys win over those of its base, in [room] too.
// clang-format on
struct SceneFile {
  std::string name;
  std::string description;
  std::string source_path;  ///< path, or the name of an embedded scene
  std::vector<Solid> solids;
  std::vector<SceneLayer> layers;  ///< the files that it was read from: the lowest base first, itself last
  std::string text;                ///< TOML that describes all of it without a base, mesh files excepted
};

/// Reads a scene: an embedded one by its name, otherwise a file.
/// \throws InputError `FILE:LINE: ...` for a missing or broken file or base, an unknown kind or geometry key,
/// a
///         missing or wrong value.
SceneFile loadScene(const std::string& name_or_path);

/// The same from TOML text. `source` names it in messages; other files are sought beside it.
SceneFile parseScene(std::string_view text, const std::string& source);

/// applyToml() of a scene's configuration, that of its bases first. \throws InputError as applyToml()
void applyScene(Settings& settings, const SceneFile& scene);

struct EmbeddedScene {
  std::string name;
  std::string description;
};
/// Scenes that are compiled into the program, by name.
std::vector<EmbeddedScene> embeddedScenes();

/// Surfaces of all solids in one mesh, with their colours; the room only if wanted.
TriangleMesh sceneMesh(const SceneFile& scene, bool include_room);

}  // namespace vantage
