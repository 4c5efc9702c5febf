#include "core/motion/trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/check.h"
#include "core/motion/robot_model.h"

namespace vantage {
namespace {

constexpr double kSlack = 1e-9;     // rad or m beyond a limit that rounding may add
constexpr double kRounding = 1e-6;  // share of a velocity that rounding may add

/// Share of a straight motion that is done, and its rate, over time: up a ramp, along, down a ramp.
class Trapezoid {
 public:
  /// \param full_speed_s time for the whole motion at full speed
  Trapezoid(double full_speed_s, double ramp_s)
      : rate_(1.0 / std::max(full_speed_s, std::sqrt(full_speed_s * ramp_s))),
        ramp_s_(full_speed_s >= ramp_s ? ramp_s : std::sqrt(full_speed_s * ramp_s)),
        duration_s_(1.0 / rate_ + ramp_s_) {}

  double duration_s() const { return duration_s_; }
  double rate(double t) const { return rate_ * std::clamp(std::min(t, duration_s_ - t) / ramp_s_, 0.0, 1.0); }
  double share(double t) const {
    if (t <= ramp_s_) return 0.5 * rate_ * t * t / ramp_s_;
    if (t <= duration_s_ - ramp_s_) return rate_ * (t - 0.5 * ramp_s_);
    return 1.0 - share(duration_s_ - t);
  }

 private:
  double rate_, ramp_s_, duration_s_;
};

void append(JointTrajectory& trajectory, double time_s, const JointVector& q, const JointVector& velocity) {
  trajectory.time_s.push_back(time_s);
  trajectory.positions.push_back(q);
  trajectory.velocities.push_back(velocity);
}

double fullSpeedTime(const RobotModel& model, const JointVector& step, double speed_share) {
  double slowest_s = 0.0;
  for (int i = 0; i < model.jointCount(); ++i)
    slowest_s = std::max(slowest_s, std::abs(step[i]) / (speed_share * model.joints[i].max_velocity));
  return slowest_s;
}

}  // namespace

void MotionTiming::validate() const {
  requireInRange("arm.speed_share", speed_share, 1e-3, 1.0);
  requireInRange("arm.ramp_s", ramp_s, 1e-3, 60.0);
  requireInRange("arm.period_s", period_s, 1e-3, 1.0);
}

JointTrajectory timedTrajectory(const RobotModel& model, const std::vector<JointVector>& corners,
                                const MotionTiming& timing) {
  timing.validate();
  const JointVector rest = JointVector::Zero(model.jointCount());
  JointTrajectory trajectory;
  append(trajectory, 0.0, corners.front(), rest);
  for (std::size_t c = 1; c < corners.size(); ++c) {
    const JointVector step = corners[c] - corners[c - 1];
    const double full_speed_s = fullSpeedTime(model, step, timing.speed_share);
    if (full_speed_s <= 0.0) continue;
    const Trapezoid profile(full_speed_s, timing.ramp_s);
    const double begin_s = trajectory.duration_s();
    const auto points = static_cast<int>(std::ceil(profile.duration_s() / timing.period_s));
    for (int p = 1; p < points; ++p) {
      const double t = profile.duration_s() * p / points;
      append(trajectory, begin_s + t, corners[c - 1] + step * profile.share(t), step * profile.rate(t));
    }
    append(trajectory, begin_s + profile.duration_s(), corners[c], rest);
  }
  return trajectory;
}

std::string limitViolation(const RobotModel& model, const JointTrajectory& trajectory) {
  if (trajectory.size() == 0) return "the motion has no points";
  for (std::size_t p = 0; p < trajectory.size(); ++p) {
    const JointVector& q = trajectory.positions[p];
    const double step_s = p > 0 ? trajectory.time_s[p] - trajectory.time_s[p - 1] : 0.0;
    if (!std::isfinite(trajectory.time_s[p]) || (p > 0 && !(step_s > 0.0)))
      return fmt::format("point {} of the motion is not later than the one before", p);
    if (q.size() != model.jointCount() || trajectory.velocities[p].size() != model.jointCount())
      return fmt::format("point {} of the motion has {} joints, the arm {}", p, q.size(), model.jointCount());
    for (int i = 0; i < model.jointCount(); ++i) {
      const ArmJoint& joint = model.joints[i];
      if (!(q[i] >= joint.lower - kSlack && q[i] <= joint.upper + kSlack))
        return fmt::format("{} would go to {:.4f}; its limits are {:.4f} .. {:.4f}", joint.name, q[i],
                           joint.lower, joint.upper);
      const double between = p > 0 ? std::abs(q[i] - trajectory.positions[p - 1][i]) / step_s : 0.0;
      const double fastest = std::max(between, std::abs(trajectory.velocities[p][i]));
      if (!(fastest <= joint.max_velocity * (1.0 + kRounding)))
        return fmt::format("{} would move at {:.4f} a second; it can do {:.4f}", joint.name, fastest,
                           joint.max_velocity);
    }
  }
  return {};
}

}  // namespace vantage
