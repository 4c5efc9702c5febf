#include "core/geometry/icosphere.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace vantage {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// Section 10.5.
TEST(Icosphere, HasTheExactNumbersOfFacesAndVertices) {
  const std::size_t faces[] = {20, 80, 320, 1280}, vertices[] = {12, 42, 162, 642};
  for (int n = 0; n < 4; ++n) {
    const Icosphere sphere = makeIcosphere(n);
    EXPECT_EQ(sphere.faces.size(), faces[n]);
    EXPECT_EQ(sphere.vertices.size(), vertices[n]);
  }
}

TEST(Icosphere, VerticesLieOnTheUnitSphereAndFacesLookOutward) {
  for (int n = 0; n < 4; ++n) {
    const Icosphere sphere = makeIcosphere(n);
    for (const Eigen::Vector3d& v : sphere.vertices) EXPECT_NEAR(v.norm(), 1.0, 1e-14);
    for (const auto& [a, b, c] : sphere.faces) {
      const Eigen::Vector3d &p = sphere.vertices[a], &q = sphere.vertices[b], &r = sphere.vertices[c];
      EXPECT_GT((q - p).cross(r - p).dot(p + q + r), 0.0);
    }
  }
}

// Section 10.5.
TEST(Icosphere, DirectionsSumToZero) {
  for (int n = 0; n < 4; ++n) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& d : faceDirections(makeIcosphere(n))) {
      EXPECT_NEAR(d.norm(), 1.0, 1e-14);
      sum += d;
    }
    EXPECT_LT(sum.norm(), 1e-12);
  }
}

// Section 10.5.
TEST(Icosphere, NearestNeighboursOf320DirectionsAre8_91To10_64DegreesApart) {
  const std::vector<Eigen::Vector3d> directions = faceDirections(makeIcosphere(2));
  ASSERT_EQ(directions.size(), 320u);
  double smallest = 180.0, largest = 0.0;
  for (const Eigen::Vector3d& d : directions) {
    double nearest = 180.0;
    for (const Eigen::Vector3d& other : directions)
      if (&other != &d) nearest = std::min(nearest, std::acos(std::min(1.0, d.dot(other))) / kDegree);
    smallest = std::min(smallest, nearest);
    largest = std::max(largest, nearest);
  }
  EXPECT_NEAR(smallest, 8.91, 0.005);
  EXPECT_NEAR(largest, 10.64, 0.005);
}

TEST(Icosphere, RefusesSubdivisionsOutOfRange) {
  EXPECT_THROW(makeIcosphere(-1), std::invalid_argument);
  EXPECT_THROW(makeIcosphere(7), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
