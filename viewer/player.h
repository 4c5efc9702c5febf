#pragma once

namespace vantage {

/// Place on the timeline of a run.
struct TimelinePlace {
  int step = 0;   ///< index of the step, 0 first; not its number
  int stage = 0;  ///< index of the stage inside it
  bool operator==(const TimelinePlace&) const = default;
};

/// The clock that moves a run on, step by step or stage by stage.
class Player {
 public:
  static constexpr double kSlowest = 0.25, kFastest = 8.0;  ///< places a second

  bool playing() const { return playing_; }
  bool loop = false;
  bool by_stage = false;  ///< stops at every stage inside a step
  /// Places a second.
  double speed() const { return speed_; }
  /// Clamped to kSlowest..kFastest.
  void setSpeed(double places_per_s);
  void play();
  void pause() { playing_ = false; }

  /// Where the run stands after some time has passed. Time that was not used is kept for the next call, at
  /// most one place. At the end it stops, or starts over with `loop`. \param steps of the run, \param stages
  /// inside a step, each >= 1
  TimelinePlace advanced(TimelinePlace at, int steps, int stages, double elapsed_s);
  /// One place on; false at the end.
  bool next(TimelinePlace& at, int steps, int stages) const;
  /// One place back; false at the start.
  bool previous(TimelinePlace& at, int stages) const;

 private:
  bool playing_ = false;
  double speed_ = 1.0;
  double waited_s_ = 0.0;
};

}  // namespace vantage
