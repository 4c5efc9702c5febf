#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/triangle_mesh.h"

namespace vantage {

/// Vertices and faces of a PLY file's contents. \throws InputError. Internal to loadMesh() and readCloud().
/// \param normals if given, receives `nx`, `ny`, `nz` of every vertex as the file states them, or stays empty
/// if it
///                states none.
TriangleMesh parsePly(std::string_view bytes, const std::string& path,
                      std::vector<Eigen::Vector3f>* normals = nullptr);

}  // namespace vantage
