#include "viewer/map_pool.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <thread>

namespace vantage {
namespace {

/// Stands for a map: its content must fit its step.
struct Counter {
  std::vector<int> content = std::vector<int>(100, 0);
  int step = 0;
  bool whole() const {
    for (const int c : content)
      if (c != step) return false;
    return true;
  }
};

std::unique_ptr<Counter> make() {
  return std::make_unique<Counter>();
}

void move(Counter& counter, int step) {
  for (int& c : counter.content) c = step;
}

TEST(MapPool, HandsOutTheSameMapWhileSomeoneHoldsIt) {
  MapPool<Counter> pool(2);
  const auto first = pool.at(3, make, move);
  EXPECT_EQ(pool.at(3, make, move), first);
  EXPECT_EQ(pool.size(), 1u);
}

TEST(MapPool, NeverChangesAMapThatSomeoneHoldsAndUsesOthersAgain) {
  MapPool<Counter> pool(2);
  auto shown = pool.at(1, make, move);
  for (int step = 2; step < 20; ++step) {
    auto next = pool.at(step, make, move);
    EXPECT_EQ(shown->step, step - 1);
    EXPECT_TRUE(shown->whole() && next->whole());
    shown = std::move(next);
  }
  EXPECT_EQ(pool.size(), 2u);
}

TEST(MapPool, BringsTheNearestFreeMapToAStep) {
  MapPool<Counter> pool(2);
  const Counter* far = nullptr;
  const Counter* near = nullptr;
  {
    const auto a = pool.at(1, make, move), b = pool.at(9, make, move);
    far = a.get();
    near = b.get();
  }
  EXPECT_EQ(pool.at(7, make, move).get(), near);
  EXPECT_EQ(pool.at(2, make, move).get(), far);
}

TEST(MapPool, HasRoomWhileAMapIsFreeOrOneMoreIsAllowed) {
  MapPool<Counter> pool(2);
  EXPECT_TRUE(pool.hasRoom());
  auto a = pool.at(1, make, move);
  EXPECT_TRUE(pool.hasRoom());
  const auto b = pool.at(2, make, move);
  EXPECT_FALSE(pool.hasRoom());
  a.reset();
  EXPECT_TRUE(pool.hasRoom());
}

TEST(MapPool, FreesMapsBeyondThoseItKeepsWhenTheyAreGivenBack) {
  MapPool<Counter> pool(2);
  auto a = pool.at(1, make, move), b = pool.at(2, make, move), c = pool.at(3, make, move);
  EXPECT_EQ(pool.size(), 3u);
  b.reset();
  EXPECT_EQ(pool.size(), 2u);
  a.reset();
  EXPECT_EQ(pool.size(), 2u);
  EXPECT_TRUE(pool.hasRoom());
  EXPECT_TRUE(c->whole() && pool.at(9, make, move)->whole());
  EXPECT_EQ(pool.size(), 2u);
}

TEST(MapPool, ThrowsAMapAwayThatCouldNotBeBroughtToItsStep) {
  MapPool<Counter> pool(2);
  const auto fail = [](Counter& counter, int) {
    counter.content[0] = 77;
    throw std::runtime_error("damaged");
  };
  EXPECT_THROW(pool.at(4, make, fail), std::runtime_error);
  EXPECT_EQ(pool.size(), 0u);
  EXPECT_TRUE(pool.at(4, make, move)->whole());
}

TEST(MapPool, MapsOutliveThePool) {
  std::shared_ptr<const Counter> kept;
  {
    MapPool<Counter> pool(2);
    kept = pool.at(5, make, move);
  }
  EXPECT_TRUE(kept->whole());
}

TEST(MapPool, MapsThatNobodyHoldsGoWithThePool) {
  struct Witnessed {
    std::shared_ptr<int> witness;
    int step = 0;
  };
  const auto witness = std::make_shared<int>(0);
  const auto make_witnessed = [&] { return std::make_unique<Witnessed>(Witnessed{witness}); };
  std::shared_ptr<const Witnessed> kept;
  {
    MapPool<Witnessed> pool(2);
    kept = pool.at(1, make_witnessed, [](Witnessed&, int) {});
    pool.at(2, make_witnessed, [](Witnessed&, int) {});
    EXPECT_EQ(witness.use_count(), 3);
  }
  kept.reset();
  EXPECT_EQ(witness.use_count(), 1);
}

TEST(MapPool, MapsMayBeDroppedOnOtherThreads) {
  MapPool<Counter> pool(2);
  std::mt19937 random(1);
  std::vector<std::jthread> readers;
  for (int round = 0; round < 400; ++round) {
    const int step = static_cast<int>(random() % 6);
    readers.emplace_back([map = pool.at(step, make, move), step] {
      EXPECT_EQ(map->step, step);
      EXPECT_TRUE(map->whole());
    });
    if (readers.size() > 3) readers.erase(readers.begin());
  }
  readers.clear();
  EXPECT_LE(pool.size(), 6u);
}

}  // namespace
}  // namespace vantage
