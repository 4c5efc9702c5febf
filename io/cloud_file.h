#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/perception/surface_cloud.h"
#include "io/error.h"

namespace vantage {

/// Reads a point cloud by the ending of its name: PCD (ASCII, binary, compressed) or PLY. Points that are not
/// finite are left out; normals are taken over (unit length), or estimated by estimateNormals() with the
/// sensor origin of the file (PCD's VIEWPOINT; PLY: the origin) if the file has none. Triangles are those of
/// a PLY mesh. \throws InputError naming the file (and line): missing, of another kind, damaged, or without
/// any finite point.
SurfaceCloud readCloud(const std::string& path);

/// Unit normals by principal components of the `neighbours` nearest points, turned toward `sensor_origin`.
/// The same for any number of threads.
std::vector<Eigen::Vector3f> estimateNormals(const std::vector<Eigen::Vector3f>& points,
                                             const Eigen::Vector3f& sensor_origin, int neighbours = 30);

/// Writes points with normals, `.pcd` (binary) or `.ply` (then with the triangles).
/// \throws InputError if it cannot be created or has another ending, std::runtime_error if it cannot be
/// written in full.
void writeCloud(const std::string& path, const SurfaceCloud& cloud);

/// Writes points, normals and one `label` (uint32, 0 = no segment) a point as binary PCD.
/// \throws as writeCloud(), std::invalid_argument if the numbers of points and
/// labels differ.
void writeLabelledCloud(const std::string& path, const SurfaceCloud& cloud,
                        const std::vector<std::uint32_t>& labels);

/// Writes the triangle mesh with one normal a vertex as binary PLY. \throws std::runtime_error if it cannot
/// be written.
void writeMesh(const std::string& path, const SurfaceCloud& cloud);

}  // namespace vantage
