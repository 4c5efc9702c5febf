#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "io/mesh_file.h"
#include "scene_support.h"

namespace vantage {
namespace {

using test::inputError;
using test::TestFolder;
using ::testing::HasSubstr;

const std::array<std::array<float, 3>, 4> kVertices = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1.5f}}};
const std::array<std::array<std::int32_t, 3>, 4> kFaces = {{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

template <class T>
void put(std::string& bytes, T value, bool big = false) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  if (big) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

std::string plyHeader(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment test\nelement vertex 4\nproperty float x\nproperty float y\nproperty uchar red\n"
         "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
}
std::string binaryPly(bool big) {
  std::string bytes = plyHeader(big ? "binary_big_endian" : "binary_little_endian");
  for (const auto& v : kVertices) {
    put(bytes, v[0], big), put(bytes, v[1], big), put(bytes, std::uint8_t{200}, big), put(bytes, v[2], big);
  }
  for (const auto& f : kFaces) {
    put(bytes, std::uint8_t{3});
    for (const std::int32_t i : f) put(bytes, i, big);
  }
  return bytes;
}
std::string asciiPly() {
  return plyHeader("ascii") +
         "0 0 200 0\n1 0 200 0\n0 1 200 0\n0 0 200 1.5\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
}
std::string binaryStl() {
  std::string bytes(80, ' ');
  put(bytes, std::uint32_t{4});
  for (const auto& f : kFaces) {
    for (int i = 0; i < 3; ++i) put(bytes, 0.0f);
    for (const std::int32_t i : f)
      for (const float c : kVertices[static_cast<std::size_t>(i)]) put(bytes, c);
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}
std::string asciiStl() {
  std::string text = "solid test\n";
  for (const auto& f : kFaces) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const std::int32_t i : f) {
      const auto& v = kVertices[static_cast<std::size_t>(i)];
      text += "   vertex " + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) +
              "\n";
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid test\n";
}
const std::string kObj =
    "# test\r\nv 0 0 0\r\nv 1 0 0\nv 0 1 0\nv 0 0 1.5\nvn 0 0 1\nf 1 3 2\nf 1//1 2//1 4//1\nf -4 -1 -2\nf "
    "2/1/1 3/1/1 4/1/1\n";

void expectTetrahedron(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.triangles.size(), 4u);
  double volume = 0;
  for (const auto& t : mesh.triangles)
    volume += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6;
  EXPECT_NEAR(volume, 0.25, 1e-6);
}

TEST(MeshFile, ReadsEveryFormat) {
  const TestFolder folder;
  expectTetrahedron(loadMesh(folder.write("a.ply", asciiPly())));
  expectTetrahedron(loadMesh(folder.write("b.PLY", binaryPly(false))));
  expectTetrahedron(loadMesh(folder.write("c.ply", binaryPly(true))));
  expectTetrahedron(loadMesh(folder.write("d.stl", binaryStl())));
  expectTetrahedron(loadMesh(folder.write("e.stl", asciiStl())));
  expectTetrahedron(loadMesh(folder.write("f.obj", kObj)));
}

TEST(MeshFile, SplitsPolygonsIntoFans) {
  const TestFolder folder;
  const TriangleMesh mesh =
      loadMesh(folder.write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"));
  EXPECT_THAT(mesh.triangles,
              ::testing::ElementsAre(::testing::ElementsAre(0, 1, 2), ::testing::ElementsAre(0, 2, 3)));
}

TEST(MeshFile, SaysWhereAFileIsBroken) {
  const TestFolder folder;
  const auto error = [&](const std::string& name, const std::string& bytes) {
    return inputError([&] { loadMesh(folder.write(name, bytes)); });
  };
  EXPECT_THAT(error("a.obj", "v 0 0\n"), HasSubstr("a.obj:1: "));
  EXPECT_THAT(error("a.obj", "v 0 0 0\nf 1 2 9\n"), HasSubstr("a.obj:2: "));
  EXPECT_THAT(error("a.obj", "v 0 0 nan\n"), HasSubstr("not finite"));
  EXPECT_THAT(error("a.obj", "hello\n"), HasSubstr("holds no triangles"));
  EXPECT_THAT(error("a.obj", ""), HasSubstr("is empty"));
  EXPECT_THAT(error("a.xyz", "1"), HasSubstr("unknown mesh format"));
  EXPECT_THAT(error("a.stl", "solid a\nfacet\nvertex 1 2 3\nendfacet\n"), HasSubstr("a.stl:4: "));
  EXPECT_THAT(error("a.ply", "plx\n"), HasSubstr("no PLY"));
  EXPECT_THAT(
      error("a.ply", "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nend_header\n"),
      HasSubstr("more than it can hold"));
  std::string far = asciiPly();
  far.replace(far.rfind("3 1 2 3"), 7, "3 1 2 7");
  EXPECT_THAT(error("a.ply", far), HasSubstr("a.ply:19: "));
  EXPECT_THAT(inputError([] { loadMesh("/nowhere/a.ply"); }), HasSubstr("no such mesh file"));
}

TEST(MeshFile, EveryTruncationIsRefusedOrSmaller) {
  const TestFolder folder;
  for (const auto& [name, bytes] :
       std::vector<std::pair<std::string, std::string>>{{"a.ply", asciiPly()},
                                                        {"b.ply", binaryPly(false)},
                                                        {"c.stl", binaryStl()},
                                                        {"d.obj", kObj},
                                                        {"e.stl", asciiStl()}}) {
    int refused = 0;
    for (std::size_t length = 0; length < bytes.size(); length += 5) {
      try {
        EXPECT_LE(loadMesh(folder.write(name, bytes.substr(0, length))).triangles.size(), 4u);
      } catch (const InputError&) {
        ++refused;
      }
    }
    EXPECT_GT(refused, 10) << name;
  }
}

TEST(MeshFile, ChangedBytesNeverDoWorseThanAnInputError) {
  const TestFolder folder;
  std::uint32_t state = 12345;
  const auto next = [&] { return state = state * 1664525u + 1013904223u; };
  for (const auto& [name, bytes] : std::vector<std::pair<std::string, std::string>>{
           {"a.ply", asciiPly()}, {"b.ply", binaryPly(false)}, {"c.stl", binaryStl()}, {"d.obj", kObj}}) {
    for (int round = 0; round < 100; ++round) {
      std::string changed = bytes;
      for (int i = 0; i < 3; ++i) changed[(next() >> 8) % changed.size()] = static_cast<char>(next() >> 16);
      try {
        const TriangleMesh mesh = loadMesh(folder.write(name, changed));
        for (const auto& t : mesh.triangles)
          for (const std::uint32_t corner : t) ASSERT_LT(corner, mesh.vertices.size());
      } catch (const InputError&) {
      }
    }
  }
}

}  // namespace
}  // namespace vantage
