#include "core/perception/saliency.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>
#include <random>

namespace vantage {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// A labelled cloud that grows part by part.
struct LabelledCloud {
  SurfaceCloud cloud;
  Labels labels;

  void add(const Vector3d& p, std::uint32_t label) {
    cloud.points.push_back(p.cast<float>());
    cloud.normals.push_back(Vector3f::UnitZ());
    labels.of_point.push_back(label);
    labels.count = std::max(labels.count, label);
  }
};

constexpr double kStep = 0.002;

/// Rectangle origin + s u + t v, points at cell centres 2 mm apart.
void addRectangle(LabelledCloud& out, const Vector3d& origin, const Vector3d& u, const Vector3d& v,
                  std::uint32_t label) {
  const int nu = static_cast<int>(std::lround(u.norm() / kStep)),
            nv = static_cast<int>(std::lround(v.norm() / kStep));
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j) out.add(origin + (i + 0.5) / nu * u + (j + 0.5) / nv * v, label);
}

/// Which faces of the box of 12.5 are there: 12 x 10 x 16 cm, standing on z = 0.
struct Faces {
  bool front = true, back = true, left = true, right = true, top = true;
};

void addBox(LabelledCloud& out, const Faces& faces, std::uint32_t label) {
  const double x = 0.06, y = 0.05, h = 0.16;
  const Vector3d ux(2 * x, 0, 0), uy(0, 2 * y, 0), uz(0, 0, h);
  if (faces.front) addRectangle(out, {-x, -y, 0}, ux, uz, label);
  if (faces.back) addRectangle(out, {-x, y, 0}, ux, uz, label);
  if (faces.left) addRectangle(out, {-x, -y, 0}, uy, uz, label);
  if (faces.right) addRectangle(out, {x, -y, 0}, uy, uz, label);
  if (faces.top) addRectangle(out, {-x, -y, h}, ux, uy, label);
}

/// Table plane around the box's footprint.
void addTable(LabelledCloud& out, std::uint32_t label) {
  for (int i = -150; i < 150; ++i)
    for (int j = -150; j < 150; ++j) {
      const double px = (i + 0.5) * kStep, py = (j + 0.5) * kStep;
      if (std::abs(px) > 0.06 || std::abs(py) > 0.05) out.add({px, py, 0.0}, label);
    }
}

/// Evenly spread directions (Fibonacci lattice).
std::vector<Vector3d> directions(int count) {
  std::vector<Vector3d> result;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count, phi = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double rho = std::sqrt(1.0 - z * z);
    result.emplace_back(rho * std::cos(phi), rho * std::sin(phi), z);
  }
  return result;
}

Segment first(const LabelledCloud& c, const SaliencyConfig& config = {}) {
  return computeSaliency(c.cloud, c.labels, config).segments.at(0);
}

// ---- 12.5

TEST(SaliencySpec, IsolatedSphere) {
  LabelledCloud c;
  for (const auto& d : directions(40000)) c.add(0.1 * d, 1);
  const Segment s = first(c);
  EXPECT_NEAR(s.roundness, 1.0, 0.01);
  EXPECT_EQ(s.isolation, 1.0);
  EXPECT_NEAR(s.saliency, 1.0, 0.01);
}

TEST(SaliencySpec, Hemisphere) {
  LabelledCloud c;
  for (const auto& d : directions(40000))
    if (d.z() >= 0) c.add(0.1 * d, 1);
  EXPECT_NEAR(first(c).roundness, 0.5, 0.01);
  EXPECT_NEAR(first(c).saliency, 0.5, 0.01);
}

LabelledCloud cylinderWall(double angle_rad) {
  LabelledCloud c;
  const int around = 160, up = 100;
  for (int i = 0; i < around; ++i)
    for (int k = 0; k < up; ++k) {
      const double a = angle_rad * (i + 0.5) / around;
      c.add({0.05 * std::cos(a), 0.05 * std::sin(a), 0.2 * (k + 0.5) / up}, 1);
    }
  return c;
}

TEST(SaliencySpec, ClosedCylinderWall) {
  EXPECT_NEAR(first(cylinderWall(2 * std::numbers::pi)).roundness, 0.5, 0.01);
  EXPECT_NEAR(first(cylinderWall(2 * std::numbers::pi)).saliency, 0.5, 0.01);
}

TEST(SaliencySpec, HalfACylinderWall) {
  EXPECT_NEAR(first(cylinderWall(std::numbers::pi)).roundness, 0.25, 0.01);
  EXPECT_NEAR(first(cylinderWall(std::numbers::pi)).saliency, 0.25, 0.01);
}

TEST(SaliencySpec, Plate) {
  LabelledCloud c;
  addRectangle(c, {0, 0, 0}, {0.2, 0, 0}, {0, 0.1, 0}, 1);
  EXPECT_NEAR(first(c).roundness, 0.0, 1e-6);
  EXPECT_NEAR(first(c).saliency, 0.0, 1e-6);
}

TEST(SaliencySpec, BoxOnATableWithFourSidesAndTop) {
  LabelledCloud c;
  addBox(c, {}, 1);
  addTable(c, 2);
  const Segment s = first(c);
  EXPECT_NEAR(s.roundness, 0.625, 0.01);
  EXPECT_NEAR(s.isolation, 0.8932, 0.01);
  EXPECT_NEAR(s.saliency, 0.558, 0.01);
}

TEST(SaliencySpec, BoxWithTwoSidesAndTop) {
  LabelledCloud c;
  addBox(c, {.front = true, .back = false, .left = true, .right = false, .top = true}, 1);
  EXPECT_NEAR(first(c).roundness, 0.717, 0.01);
}

TEST(SaliencySpec, BoxWithOneSideAndTop) {
  LabelledCloud c;
  addBox(c, {.front = true, .back = false, .left = false, .right = false, .top = true}, 1);
  EXPECT_NEAR(first(c).roundness, 0.497, 0.01);
}

TEST(SaliencySpec, OneFaceOfABox) {
  LabelledCloud c;
  addBox(c, {.front = true, .back = false, .left = false, .right = false, .top = false}, 1);
  EXPECT_NEAR(first(c).roundness, 0.0, 0.01);
}

TEST(SaliencySpec, CubeWithSixFacesHasAnyAxes) {
  LabelledCloud c;
  const double a = 0.05;
  const Vector3d ux(2 * a, 0, 0), uy(0, 2 * a, 0), uz(0, 0, 2 * a);
  for (const double s : {-a, a}) {
    addRectangle(c, {-a, -a, s}, ux, uy, 1);
    addRectangle(c, {-a, s, -a}, ux, uz, 1);
    addRectangle(c, {s, -a, -a}, uy, uz, 1);
  }
  // Any axes fit an isotropic covariance; the extents of a cube differ most, by sqrt 2, for a turn of 45 deg
  // about an edge direction.
  EXPECT_GE(first(c).roundness, 1.0 / std::numbers::sqrt2 - 0.01);
  EXPECT_LE(first(c).roundness, 1.0);
}

TEST(SaliencySpec, TooLargeAnIsolationDistanceTurnsSmallObjectsBlack) {
  LabelledCloud c;
  addBox(c, {}, 1);
  addTable(c, 2);
  SaliencyConfig config;
  config.isolation_distance_m = 0.2;
  EXPECT_EQ(first(c, config).saliency, 0.0);
}

// ---- Shape

TEST(Saliency, OrientedBoxIsFoundWhateverTheRotation) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Vector3d t(0.4, -0.2, 1.0);
  LabelledCloud c;
  for (int i = 0; i <= 30; ++i)
    for (int j = 0; j <= 20; ++j)
      for (int k = 0; k <= 10; ++k) c.add(R * Vector3d(0.01 * i, 0.01 * j, 0.01 * k) + t, 1);
  const Segment s = first(c);
  EXPECT_LT((s.extent_m - Vector3d(0.3, 0.2, 0.1)).norm(), 1e-5);
  EXPECT_LT((s.center_m - (R * Vector3d(0.15, 0.1, 0.05) + t)).norm(), 1e-6);
  EXPECT_NEAR(s.radius_m, Vector3d(0.15, 0.1, 0.05).norm(), 1e-6);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(std::abs(s.axes.col(a).dot(R.col(a))), 1.0, 1e-6);
  EXPECT_NEAR(s.roundness, 1.0 / 3.0, 1e-5);
}

TEST(Saliency, SphereHoldsEveryPointAndTouchesOne) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  LabelledCloud c;
  for (int i = 0; i < 500; ++i) c.add({normal(random), 2 * normal(random), std::abs(normal(random))}, 1);
  const Segment s = first(c);
  double farthest = 0.0;
  for (const auto& p : c.cloud.points) farthest = std::max(farthest, (p.cast<double>() - s.center_m).norm());
  EXPECT_DOUBLE_EQ(s.radius_m, farthest);
  EXPECT_GT((s.center_m - s.mean_m).norm(), 0.01);  // the box is not centred on the mean (D-B17)
}

TEST(Saliency, SmallOrPointLikeSegmentsHaveNone) {
  LabelledCloud c;
  for (int i = 0; i < 9; ++i) c.add({0.01 * i, 0.001 * (i % 3), 0.001 * (i % 2)}, 1);
  for (int i = 0; i < 20; ++i) c.add({5, 5, 5}, 2);
  const Saliency s = computeSaliency(c.cloud, c.labels, {});
  EXPECT_EQ(s.segments[0].saliency, 0.0);
  EXPECT_GT(s.segments[0].roundness, 0.0);
  EXPECT_EQ(s.segments[1].saliency, 0.0);
  EXPECT_EQ(s.segments[1].roundness, 0.0);
  SaliencyConfig config;
  config.min_points = 9;
  EXPECT_GT(computeSaliency(c.cloud, c.labels, config).segments[0].saliency, 0.0);
}

TEST(Saliency, AblationsReplaceTheirFactorByOne) {
  LabelledCloud c;
  addBox(c, {}, 1);
  addTable(c, 2);
  SaliencyConfig no_isolation, no_roundness;
  no_isolation.use_isolation = false;
  no_roundness.use_roundness = false;
  EXPECT_EQ(first(c, no_isolation).saliency, first(c).roundness);
  EXPECT_EQ(first(c, no_roundness).saliency, first(c).isolation);
}

// ---- Distances

LabelledCloud randomClutter(unsigned seed, int points, int labels) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  std::vector<Vector3d> centres;
  for (int k = 0; k <= labels; ++k) centres.emplace_back(uniform(random), uniform(random), uniform(random));
  LabelledCloud c;
  for (int i = 0; i < points; ++i) {
    const auto label = static_cast<std::uint32_t>(random() % (labels + 1));
    c.add(centres[label] + 0.08 * Vector3d(normal(random), normal(random), 0.1 * normal(random)), label);
  }
  return c;
}

std::vector<float> bruteForce(const LabelledCloud& c, float cap) {
  std::vector<float> result(c.cloud.points.size(), cap);
  for (std::size_t i = 0; i < result.size(); ++i)
    for (std::size_t j = 0; j < result.size(); ++j) {
      if (c.labels.of_point[i] == c.labels.of_point[j]) continue;
      const Vector3f d = c.cloud.points[i] - c.cloud.points[j];
      result[i] = std::min(result[i], std::sqrt(d.x() * d.x() + d.y() * d.y() + d.z() * d.z()));
    }
  return result;
}

TEST(SaliencyDistances, EqualThoseOfComparingEveryPair) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const LabelledCloud c = randomClutter(seed, 1500, 1 + static_cast<int>(seed));
    for (const double cap : {0.02, 0.2}) {
      SaliencyConfig config;
      config.max_distance_m = cap;
      config.isolation_distance_m = std::min(cap, 0.02);
      const auto distances = computeSaliency(c.cloud, c.labels, config).distance_to_other_m;
      EXPECT_EQ(distances, bruteForce(c, static_cast<float>(cap))) << seed << ' ' << cap;
    }
  }
}

TEST(SaliencyDistances, RescoringAgreesExactlyWithAFreshRunForEveryIsolationDistance) {
  const LabelledCloud c = randomClutter(9, 3000, 6);
  const Saliency kept = computeSaliency(c.cloud, c.labels, {});
  double previous = 2.0;
  for (const double distance : {0.005, 0.01, 0.015, 0.02, 0.03, 0.05, 0.1, 0.15, 0.2}) {
    SaliencyConfig config;
    config.isolation_distance_m = distance;
    const auto fresh = computeSaliency(c.cloud, c.labels, config).segments;
    const auto rescored = rescoreSegments(kept, c.labels, config);
    ASSERT_EQ(rescored.size(), fresh.size());
    double sum = 0.0;
    for (std::size_t k = 0; k < fresh.size(); ++k) {
      EXPECT_EQ(rescored[k].saliency, fresh[k].saliency);
      EXPECT_EQ(rescored[k].isolation, fresh[k].isolation);
      sum += fresh[k].isolation;
    }
    EXPECT_LE(sum / fresh.size(), previous);
    previous = sum / fresh.size();
  }
  EXPECT_LT(previous, 1.0);
}

TEST(SaliencyDistances, CountAgainstEveryPairForEveryIsolationDistance) {
  const LabelledCloud c = randomClutter(3, 1500, 3);
  const auto distances = bruteForce(c, 10.0f);
  for (const double limit : {0.005, 0.01, 0.02, 0.05, 0.1, 0.2}) {
    SaliencyConfig config;
    config.isolation_distance_m = limit;
    for (const Segment& s : computeSaliency(c.cloud, c.labels, config).segments) {
      int isolated = 0;
      for (std::size_t i = 0; i < distances.size(); ++i)
        isolated += c.labels.of_point[i] == s.label && distances[i] > limit;
      EXPECT_EQ(s.isolation, static_cast<double>(isolated) / s.points);
    }
  }
}

TEST(SaliencyDistances, PointsWithoutALabelCountAsOthers) {
  LabelledCloud c;
  addRectangle(c, {0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, 1);
  EXPECT_EQ(first(c).isolation, 1.0);
  c.add({0.05, 0.05, 0.01}, 0);
  EXPECT_LT(first(c).isolation, 1.0);
  EXPECT_NEAR(computeSaliency(c.cloud, c.labels, {}).distance_to_other_m.back(), 0.01, 2e-4);
}

TEST(SaliencyDistances, PointsWithoutCoordinatesAreNobodysNeighbour) {
  LabelledCloud c;
  addRectangle(c, {0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, 1);
  c.add({NAN, 0, 0}, 0);
  c.add({0, INFINITY, 0}, 0);
  const Saliency s = computeSaliency(c.cloud, c.labels, {});
  EXPECT_EQ(s.segments[0].isolation, 1.0);
  for (const float d : s.distance_to_other_m) EXPECT_EQ(d, 0.2f);
}

TEST(SaliencyDistances, AreTheSameForOneAndTwoThreads) {
  const LabelledCloud c = randomClutter(5, 20000, 9);
  std::vector<Saliency> results;
  for (const int threads : {1, 2, 2}) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(computeSaliency(c.cloud, c.labels, {}));
  }
  for (const Saliency& other : results) {
    EXPECT_EQ(other.distance_to_other_m, results[0].distance_to_other_m);
    for (std::size_t k = 0; k < other.segments.size(); ++k) {
      EXPECT_EQ(other.segments[k].saliency, results[0].segments[k].saliency);
      EXPECT_EQ(other.segments[k].center_m, results[0].segments[k].center_m);
    }
  }
}

// ---- Edges

TEST(Saliency, AnEmptyCloudHasNoSegments) {
  const Saliency s = computeSaliency({}, {}, {});
  EXPECT_TRUE(s.segments.empty());
  EXPECT_TRUE(s.distance_to_other_m.empty());
}

TEST(Saliency, RefusesLabelsThatDoNotFit) {
  LabelledCloud c;
  c.add({0, 0, 0}, 1);
  Labels too_few, too_high = c.labels;
  EXPECT_THROW(computeSaliency(c.cloud, too_few, {}), std::invalid_argument);
  too_high.of_point[0] = 2;
  EXPECT_THROW(computeSaliency(c.cloud, too_high, {}), std::invalid_argument);
}

TEST(SaliencyConfig, RefusesAnIsolationDistanceBeyondWhatIsKept) {
  SaliencyConfig config;
  config.isolation_distance_m = 0.3;
  try {
    computeSaliency({}, {}, config);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("isolation_distance_m = 0.3"));
  }
}

TEST(BySaliency, SortsDownAndGivesTiesToTheLowerLabel) {
  std::vector<Segment> segments(5);
  const double values[] = {0.1, 0.5, 0.0, 0.5, 0.0};
  for (std::uint32_t k = 0; k < 5; ++k) {
    segments[k].label = k + 1;
    segments[k].saliency = values[k];
  }
  EXPECT_THAT(bySaliency(segments), testing::ElementsAre(1, 3, 0, 2, 4));
  EXPECT_TRUE(bySaliency({}).empty());
}

}  // namespace
}  // namespace vantage
