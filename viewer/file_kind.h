#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/error.h"

namespace vantage {

/// What the program can do something with.
enum class FileKind {
  Run,      ///< recorded exploration (`.vantage`)
  Tsdf,     ///< TSDF volume (`.vti`)
  Octree,   ///< OctoMap (`.bt`, `.ot`)
  Scene,    ///< simulated scene: built in, or TOML
  Cloud,    ///< points (`.pcd`, `.ply` without triangles)
  Mesh,     ///< triangles (`.ply`, `.obj`, `.stl`)
  Views,    ///< table of camera poses (`.csv`)
  Table,    ///< any other table (`.csv`)
  Recipe,   ///< how a picture is drawn (TOML)
  Config,   ///< parameters (TOML)
  Dataset,  ///< depth images and poses: a folder, or a .bag of ROS 1
  Unknown,
};

/// "run", "TSDF volume", ...
std::string_view nameOf(FileKind kind);

/// What a file is, by what it holds as far as that tells, else by its ending; a name that is no path may be
/// that of a built-in scene. Of large files only the beginning is read. Unknown for what is missing,
/// unreadable or none of the kinds; whyUnknown() tells which.
FileKind kindOf(const std::filesystem::path& path);

/// Why a path is of no known kind and what to do about it. \pre kindOf(path) == FileKind::Unknown
InputError whyUnknown(const std::filesystem::path& path);

/// kindOf() for callers that need to know. \throws InputError as whyUnknown()
FileKind requireKind(const std::filesystem::path& path);

/// Endings of files that kindOf() knows, with the dot, for file dialogs.
const std::vector<std::string>& knownEndings();

}  // namespace vantage
