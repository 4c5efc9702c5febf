#include "io/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "io/mesh_ply.h"
#include "io/mesh_text.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3f;

std::string readBytes(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) throw InputError(path, "no such mesh file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw InputError(path, "cannot be read: " + error.message());
  if (size == 0) throw InputError(path, "is empty; give a PLY, OBJ or STL mesh");
  if (size > (std::uintmax_t{2} << 30)) throw InputError(path, "is larger than 2 GiB");
  std::string bytes(size, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw InputError(path, "cannot be read; check its permissions");
  return bytes;
}

/// Index of an OBJ face corner "v", "v/t", "v//n" or "v/t/n": from 1, or from the end if negative.
std::uint32_t objIndex(std::string_view word, std::size_t vertices, const mesh_text::Cursor& cursor) {
  const std::string_view number = word.substr(0, word.find('/'));
  std::int64_t index = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), index);
  if (number.empty() || error != std::errc() || end != number.data() + number.size())
    cursor.fail("face corner '" + std::string(word.substr(0, 40)) + "' is no index");
  const auto count = static_cast<std::int64_t>(vertices);
  if (index < 0) index += count + 1;
  if (index < 1 || index > count)
    cursor.fail("face corner '" + std::string(word.substr(0, 40)) + "' names none of the " +
                std::to_string(count) + " vertices before it");
  return static_cast<std::uint32_t>(index - 1);
}

TriangleMesh parseObj(std::string_view bytes, const std::string& path) {
  mesh_text::Cursor cursor(bytes, path);
  TriangleMesh mesh;
  std::vector<std::uint32_t> corners;
  while (cursor.nextLine()) {
    const std::string_view word = cursor.word();
    if (word == "v") {
      const float x = cursor.coordinate(), y = cursor.coordinate(), z = cursor.coordinate();
      mesh.vertices.emplace_back(x, y, z);
    } else if (word == "f") {
      corners.clear();
      for (std::string_view c = cursor.word(); !c.empty(); c = cursor.word())
        corners.push_back(objIndex(c, mesh.vertices.size(), cursor));
      if (corners.size() < 3) cursor.fail("a face has fewer than three corners");
      for (std::size_t i = 2; i < corners.size(); ++i)
        mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
  }
  return mesh;
}

/// STL repeats the corners of every triangle; so does the mesh.
void addStlTriangle(const std::array<Vector3f, 3>& corners, TriangleMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
}

constexpr std::size_t kStlHeader = 84, kStlTriangle = 50;

std::uint64_t stlTriangles(std::string_view bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kStlHeader) std::memcpy(&count, bytes.data() + 80, sizeof(count));
  return count;
}

bool binaryStl(std::string_view bytes) {
  if (!bytes.starts_with("solid")) return true;
  return bytes.size() >= kStlHeader && kStlHeader + kStlTriangle * stlTriangles(bytes) == bytes.size();
}

TriangleMesh parseBinaryStl(std::string_view bytes, const std::string& path) {
  const std::uint64_t count = stlTriangles(bytes);
  if (bytes.size() < kStlHeader + kStlTriangle * count)
    throw InputError(path, "announces " + std::to_string(count) + " triangles but ends after " +
                               std::to_string(bytes.size()) + " bytes");
  TriangleMesh mesh;
  for (std::uint64_t i = 0; i < count; ++i) {
    std::array<float, 12> values;  // normal and three corners
    std::memcpy(values.data(), bytes.data() + kStlHeader + kStlTriangle * i, sizeof(values));
    std::array<Vector3f, 3> corners;
    for (std::size_t c = 0; c < 3; ++c)
      corners[c] = {values[3 + 3 * c], values[4 + 3 * c], values[5 + 3 * c]};
    for (const Vector3f& corner : corners)
      if (!corner.allFinite())
        throw InputError(path, "triangle " + std::to_string(i) + " has a coordinate that is not finite");
    addStlTriangle(corners, mesh);
  }
  return mesh;
}

TriangleMesh parseTextStl(std::string_view bytes, const std::string& path) {
  mesh_text::Cursor cursor(bytes, path);
  TriangleMesh mesh;
  std::array<Vector3f, 3> corners;
  std::size_t count = 0;
  while (cursor.nextLine()) {
    const std::string_view word = cursor.word();
    if (word == "vertex") {
      if (count == 3) cursor.fail("a facet has more than three vertices");
      const float x = cursor.coordinate(), y = cursor.coordinate(), z = cursor.coordinate();
      corners[count++] = {x, y, z};
    } else if (word == "endfacet") {
      if (count != 3) cursor.fail("a facet has fewer than three vertices");
      addStlTriangle(corners, mesh);
      count = 0;
    }
  }
  if (count != 0) cursor.fail("the last facet has no end");
  return mesh;
}

}  // namespace

TriangleMesh loadMesh(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (ending != ".ply" && ending != ".obj" && ending != ".stl")
    throw InputError(path, "unknown mesh format '" + ending + "'; give .ply, .obj or .stl");
  const std::string bytes = readBytes(path);
  TriangleMesh mesh;
  if (ending == ".ply")
    mesh = parsePly(bytes, path);
  else if (ending == ".obj")
    mesh = parseObj(bytes, path);
  else
    mesh = binaryStl(bytes) ? parseBinaryStl(bytes, path) : parseTextStl(bytes, path);
  if (mesh.empty()) throw InputError(path, "holds no triangles; give a mesh with faces");
  return mesh;
}

}  // namespace vantage
