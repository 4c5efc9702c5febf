#include "io/cloud_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "io/cloud_pcd.h"
#include "io/mesh_ply.h"
#include "io/text_file.h"

namespace vantage {
namespace {

constexpr std::uintmax_t kLargestCloud = std::uintmax_t{2} << 30;

std::string endingOf(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (ending != ".pcd" && ending != ".ply")
    throw InputError(path, "is not a kind of cloud that is known; allowed: .pcd | .ply");
  return ending;
}

bool usable(const Eigen::Vector3f& normal) {
  return normal.allFinite() && normal.squaredNorm() > 1e-12f;
}

/// Finite points with their normals; points whose stated normal is no direction are left out too.
SurfaceCloud fromPcd(PcdPoints file) {
  SurfaceCloud cloud;
  for (std::size_t i = 0; i < file.points.size(); ++i) {
    if (!file.points[i].allFinite() || (!file.normals.empty() && !usable(file.normals[i]))) continue;
    cloud.points.push_back(file.points[i]);
    if (!file.normals.empty()) cloud.normals.push_back(file.normals[i].normalized());
  }
  if (cloud.normals.empty()) cloud.normals = estimateNormals(cloud.points, file.sensor_origin);
  return cloud;
}

SurfaceCloud fromPly(const std::string& bytes, const std::string& path) {
  SurfaceCloud cloud;
  TriangleMesh mesh = parsePly(bytes, path, &cloud.normals);
  cloud.points = std::move(mesh.vertices);
  cloud.triangles = std::move(mesh.triangles);
  const bool stated = cloud.normals.size() == cloud.points.size() &&
                      std::all_of(cloud.normals.begin(), cloud.normals.end(), usable);
  if (!stated) cloud.normals = estimateNormals(cloud.points, Eigen::Vector3f::Zero());
  for (Eigen::Vector3f& normal : cloud.normals) normal.normalize();
  return cloud;
}

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

void appendPoint(std::string& bytes, const SurfaceCloud& cloud, std::size_t i) {
  for (int a = 0; a < 3; ++a) append(bytes, cloud.points[i][a]);
  for (int a = 0; a < 3; ++a) append(bytes, cloud.normals[i][a]);
}

void requireNormals(const SurfaceCloud& cloud) {
  if (cloud.normals.size() != cloud.points.size())
    throw std::invalid_argument("a cloud to be written has one normal a point");
}

/// Binary PCD, with labels if there are any.
void writePcd(const std::string& path, const SurfaceCloud& cloud, const std::vector<std::uint32_t>* labels) {
  requireNormals(cloud);
  const std::string count = std::to_string(cloud.points.size());
  const auto columns = [&](const char* usual, const char* label) {
    return std::string(usual) + (labels ? label : "") + "\n";
  };
  std::string bytes = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" +
                      columns("FIELDS x y z normal_x normal_y normal_z", " label") +
                      columns("SIZE 4 4 4 4 4 4", " 4") + columns("TYPE F F F F F F", " U") +
                      columns("COUNT 1 1 1 1 1 1", " 1") + "WIDTH " + count +
                      "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n";
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    appendPoint(bytes, cloud, i);
    if (labels) append(bytes, (*labels)[i]);
  }
  saveFile(path, bytes);
}

}  // namespace

SurfaceCloud readCloud(const std::string& path) {
  const std::string ending = endingOf(path);
  const std::string bytes = readTextFile(path, kLargestCloud);
  SurfaceCloud cloud = ending == ".pcd" ? fromPcd(parsePcd(bytes, path)) : fromPly(bytes, path);
  if (cloud.points.empty()) throw InputError(path, "holds no finite point");
  return cloud;
}

void writeCloud(const std::string& path, const SurfaceCloud& cloud) {
  if (endingOf(path) == ".ply") return writeMesh(path, cloud);
  writePcd(path, cloud, nullptr);
}

void writeLabelledCloud(const std::string& path, const SurfaceCloud& cloud,
                        const std::vector<std::uint32_t>& labels) {
  if (labels.size() != cloud.points.size())
    throw std::invalid_argument("writeLabelledCloud: not one label a point");
  writePcd(path, cloud, &labels);
}

void writeMesh(const std::string& path, const SurfaceCloud& cloud) {
  requireNormals(cloud);
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(cloud.points.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
      "property float nz\nelement face " +
      std::to_string(cloud.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (std::size_t i = 0; i < cloud.points.size(); ++i) appendPoint(bytes, cloud, i);
  for (const auto& triangle : cloud.triangles) {
    append(bytes, std::uint8_t{3});
    for (const std::uint32_t index : triangle) append(bytes, static_cast<std::int32_t>(index));
  }
  saveFile(path, bytes);
}

}  // namespace vantage
