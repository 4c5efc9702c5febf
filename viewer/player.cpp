#include "viewer/player.h"

#include <algorithm>

namespace vantage {

void Player::setSpeed(double places_per_s) {
  speed_ = std::clamp(places_per_s, kSlowest, kFastest);
}

void Player::play() {
  playing_ = true;
  waited_s_ = 0.0;
}

bool Player::next(TimelinePlace& at, int steps, int stages) const {
  if (by_stage && at.stage + 1 < stages) {
    ++at.stage;
    return true;
  }
  if (at.step + 1 >= steps) return false;
  ++at.step;
  if (by_stage) at.stage = 0;
  return true;
}

bool Player::previous(TimelinePlace& at, int stages) const {
  if (by_stage && at.stage > 0) {
    --at.stage;
    return true;
  }
  if (at.step == 0) return false;
  --at.step;
  if (by_stage) at.stage = stages - 1;
  return true;
}

TimelinePlace Player::advanced(TimelinePlace at, int steps, int stages, double elapsed_s) {
  if (!playing_) return at;
  waited_s_ += elapsed_s;
  const double period_s = 1.0 / speed_;
  if (waited_s_ < period_s) return at;
  waited_s_ = std::min(waited_s_ - period_s, period_s);
  if (next(at, steps, stages)) return at;
  if (!loop) {
    playing_ = false;
    return at;
  }
  return {0, by_stage ? 0 : at.stage};
}

}  // namespace vantage
