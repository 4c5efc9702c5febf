#pragma once

#include <string>

#include "core/geometry/triangle_mesh.h"
#include "io/error.h"

namespace vantage {

/// Reads a triangle mesh by the ending of its name: PLY (ASCII, binary of either byte order), OBJ, STL
/// (ASCII, binary). Polygons are split into fans. Colours, texture coordinates and normals are not taken
/// over; nothing is scaled. \throws InputError naming file and, in text, line: a missing, empty or broken
/// file, an index beyond the
///         vertices, a coordinate that is not finite, more than 2 GiB.
TriangleMesh loadMesh(const std::string& path);

}  // namespace vantage
