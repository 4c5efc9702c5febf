#pragma once

#include <string>
#include <string_view>

#include "core/geometry/triangle_mesh.h"

namespace vantage {

/// Vertices and faces of a PLY file's contents. \throws InputError. Internal to loadMesh().
TriangleMesh parsePly(std::string_view bytes, const std::string& path);

}  // namespace vantage
