#include "core/raycasting/plain_caster.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

namespace vantage::casting {
namespace {

constexpr int kSize[3] = {23, 17, 19};

/// A voxel of a walk and when the ray enters it.
struct Visit {
  std::array<int, 3> voxel;
  float entry;
  bool operator==(const Visit&) const = default;
};

/// All voxels of a walk through free space; entries by planes, as a slab method has them.
std::vector<Visit> walk(const PlainRay<float>& ray) {
  std::vector<Visit> visits;
  walkPlainly(kSize, ray, [&](int i, int j, int k) {
    const int voxel[3] = {i, j, k};
    float entry = 0.0f;
    for (int a = 0; a < 3; ++a) {
      if (ray.direction[a] == 0.0f) continue;
      const float plane = static_cast<float>(ray.direction[a] > 0 ? voxel[a] : voxel[a] + 1);
      entry = std::max(entry, (plane - ray.origin[a]) * (1.0f / ray.direction[a]));
    }
    visits.push_back({{i, j, k}, entry});
    return false;
  });
  return visits;
}

PlainRay<float> randomRay(std::mt19937_64& random) {
  std::uniform_real_distribution<float> inside(0.0f, 1.0f), direction(-1.0f, 1.0f);
  PlainRay<float> ray{};
  for (int a = 0; a < 3; ++a) {
    ray.origin[a] = kSize[a] * (random() % 4 ? inside(random) : 2 * inside(random) - 0.5f);
    if (random() % 6 == 0) ray.origin[a] = std::floor(ray.origin[a]);  // on a plane
    ray.direction[a] = random() % 7 ? direction(random) : 0.0f;
  }
  ray.end = 60.0f;
  return ray;
}

TEST(PlainWalk, ResumedGoesThroughTheSameVoxelsAsFromTheOrigin) {
  std::mt19937_64 random(9);
  int resumed_inside = 0;
  for (int n = 0; n < 4000; ++n) {
    PlainRay<float> ray = randomRay(random);
    const std::vector<Visit> whole = walk(ray);
    if (whole.empty()) continue;
    // At an entry, exactly or not, or anywhere.
    const float at = whole[random() % whole.size()].entry;
    ray.start = random() % 2 ? at : at + std::uniform_real_distribution<float>(-3.0f, 3.0f)(random);
    if (!(ray.start > 0.0f)) continue;
    std::size_t first = whole.size() - 1;  // the last voxel entered by then
    while (first > 0 && whole[first].entry > ray.start) --first;
    std::vector<Visit> expected(whole.begin() + static_cast<std::ptrdiff_t>(first), whole.end());
    const std::vector<Visit> tail = walk(ray);
    if (tail.empty()) {  // left the grid by then
      EXPECT_EQ(expected.size(), 1u) << n;
      continue;
    }
    EXPECT_EQ(tail, expected) << n;
    resumed_inside += expected.size() > 1 && first > 0;
  }
  EXPECT_GT(resumed_inside, 1000);
}

TEST(PlainWalk, ResumedBeyondItsEndVisitsNothing) {
  PlainRay<float> ray{{2.5f, 2.5f, 2.5f}, {1.0f, 0.0f, 0.0f}, 5.0f, 5.5f};
  EXPECT_TRUE(walk(ray).empty());
  ray.start = 4.5f;
  EXPECT_EQ(walk(ray).front().voxel, (std::array<int, 3>{7, 2, 2}));
}

}  // namespace
}  // namespace vantage::casting
