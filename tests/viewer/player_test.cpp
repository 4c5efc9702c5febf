#include "viewer/player.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vantage {
namespace {

constexpr int kSteps = 4, kStages = 3;

TEST(Player, StandsStillUntilItPlays) {
  Player player;
  EXPECT_EQ(player.advanced({1, 0}, kSteps, kStages, 100.0), (TimelinePlace{1, 0}));
}

TEST(Player, TakesOneStepForEveryPeriodOfItsSpeed) {
  Player player;
  player.setSpeed(2.0);
  player.play();
  TimelinePlace at{0, 1};
  at = player.advanced(at, kSteps, kStages, 0.4);
  EXPECT_EQ(at, (TimelinePlace{0, 1}));
  at = player.advanced(at, kSteps, kStages, 0.2);
  EXPECT_EQ(at, (TimelinePlace{1, 1}));
  at = player.advanced(at, kSteps, kStages, 0.3);
  EXPECT_EQ(at, (TimelinePlace{1, 1}));
  at = player.advanced(at, kSteps, kStages, 0.1);
  EXPECT_EQ(at, (TimelinePlace{2, 1}));
}

TEST(Player, StopsAtTheEndOrStartsOver) {
  Player player;
  player.play();
  EXPECT_EQ(player.advanced({kSteps - 1, 2}, kSteps, kStages, 1.0), (TimelinePlace{kSteps - 1, 2}));
  EXPECT_FALSE(player.playing());
  player.loop = true;
  player.play();
  EXPECT_EQ(player.advanced({kSteps - 1, 2}, kSteps, kStages, 1.0), (TimelinePlace{0, 2}));
  EXPECT_TRUE(player.playing());
}

TEST(Player, ByStageVisitsEveryStageOfEveryStepInBothDirections) {
  Player player;
  player.by_stage = true;
  TimelinePlace at{0, 0};
  int places = 1;
  while (player.next(at, kSteps, kStages)) ++places;
  EXPECT_EQ(places, kSteps * kStages);
  EXPECT_EQ(at, (TimelinePlace{kSteps - 1, kStages - 1}));
  while (player.previous(at, kStages)) --places;
  EXPECT_EQ(places, 1);
  EXPECT_EQ(at, (TimelinePlace{0, 0}));
}

TEST(Player, SpeedStaysInItsRange) {
  Player player;
  player.setSpeed(1e9);
  EXPECT_EQ(player.speed(), Player::kFastest);
  player.setSpeed(0.0);
  EXPECT_EQ(player.speed(), Player::kSlowest);
}

}  // namespace
}  // namespace vantage
