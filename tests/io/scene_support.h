#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "io/config_file.h"
#include "io/scene_file.h"

namespace vantage::test {

/// Folder of the running test, emptied at its start and removed at its end.
class TestFolder {
 public:
  TestFolder() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() / ("vantage_" + std::string(info->test_suite_name()) +
                                                      "_" + info->name() + "_" + std::to_string(getpid()));
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  std::string write(const std::string& name, const std::string& bytes) const {
    const std::string path = (path_ / name).string();
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

/// Message of the InputError that a call throws; fails the test if it throws nothing or something else.
template <class Call>
std::string inputError(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "no InputError but: " << error.what();
    return {};
  }
  ADD_FAILURE() << "no error";
  return {};
}

inline SceneFile sceneOf(const std::string& toml) {
  return parseScene(toml, "test.toml");
}

inline void expectEqualSolids(const SceneFile& a, const SceneFile& b) {
  ASSERT_EQ(a.solids.size(), b.solids.size());
  for (std::size_t i = 0; i < a.solids.size(); ++i) {
    EXPECT_EQ(a.solids[i].object(), b.solids[i].object());
    EXPECT_EQ(a.solids[i].role(), b.solids[i].role());
    EXPECT_EQ(a.solids[i].color(), b.solids[i].color());
    EXPECT_EQ(a.solids[i].mesh().vertices, b.solids[i].mesh().vertices) << a.solids[i].object();
  }
}

/// Points at most about 1 cm apart on the surface of all solids of an object.
inline std::vector<Eigen::Vector3d> surfaceSamples(const SceneFile& scene, const std::string& object) {
  std::vector<Eigen::Vector3d> points;
  for (const Solid& solid : scene.solids) {
    if (solid.object() != object) continue;
    const auto& vertices = solid.mesh().vertices;
    for (const auto& t : solid.mesh().triangles) {
      const Eigen::Vector3d a = vertices[t[0]].cast<double>(), b = vertices[t[1]].cast<double>(),
                            c = vertices[t[2]].cast<double>();
      const double longest = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
      const int n = std::max(1, static_cast<int>(std::ceil(longest / 0.01)));
      for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) points.push_back(a + (b - a) * i / n + (c - a) * j / n);
    }
  }
  return points;
}

/// Distance from a point to the nearest solid of another name, negative inside.
inline double distanceToOthers(const SceneFile& scene, const std::string& object, const Eigen::Vector3d& p) {
  double distance = std::numeric_limits<double>::infinity();
  for (const Solid& solid : scene.solids)
    if (solid.object() != object) distance = std::min(distance, solid.signedDistance(p));
  return distance;
}

/// The configuration that a scene makes of the defaults, without its origins.
inline std::string configurationOf(const SceneFile& scene) {
  Settings settings;
  applyScene(settings, scene);
  settings.origins.clear();
  return effectiveToml(settings);
}

}  // namespace vantage::test
