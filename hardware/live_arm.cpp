#include "hardware/live_arm.h"

#include <fmt/format.h>

#include <chrono>
#include <numbers>
#include <thread>
#include <utility>

#include "core/exploration/arm_start.h"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr double kLate_s = 5.0;     // beyond a trajectory's own time: it will not arrive
constexpr double kRest_rad = 1e-3;  // between two readings of an arm at rest, rad or m
constexpr double kLongestRest_s = 3.0;
constexpr double kSameStart_rad = 0.02;  // 1.1 deg; rad or m

/// Ends the motion however the scope is left, unless it arrived.
class MotionGuard {
 public:
  explicit MotionGuard(ArmLink& link) : link_(link) {}
  ~MotionGuard() {
    if (!arrived_) link_.cancel();
  }
  MotionGuard(const MotionGuard&) = delete;
  void arrived() { arrived_ = true; }

 private:
  ArmLink& link_;
  bool arrived_ = false;
};

}  // namespace

LiveArm::LiveArm(std::unique_ptr<ArmPlanner> planner, std::vector<JointVector> start,
                 std::unique_ptr<ArmLink> link, std::function<std::string()> watch)
    : Arm(std::move(planner), std::move(start)), link_(std::move(link)), watch_(std::move(watch)) {}

std::string LiveArm::trouble() const {
  if (std::string of_link = link_->trouble(); !of_link.empty()) return of_link;
  return watch_ ? watch_() : std::string();
}

void LiveArm::follow(const JointTrajectory& trajectory, const RunControl& control) {
  control.check();
  if (const std::string lost = trouble(); !lost.empty()) throw DeviceLost(lost);
  if (trajectory.duration_s() < planner().config().timing.period_s)
    return;  // it is there; controllers refuse such
  MotionGuard guard(*link_);
  link_->send(trajectory);
  const auto late_at = Clock::now() + Seconds(trajectory.duration_s() + kLate_s);
  const Seconds period(planner().config().timing.period_s);
  for (ArmLink::Motion motion = link_->motion(); motion != ArmLink::Motion::Arrived;
       motion = link_->motion()) {
    control.check();
    if (const std::string lost = trouble(); !lost.empty()) throw DeviceLost(lost);
    if (motion == ArmLink::Motion::Failed) throw DeviceLost(name() + ": the controller gave up the motion");
    if (Clock::now() > late_at)
      throw DeviceLost(fmt::format("{}: has not arrived {:.0f} s after it should have", name(), kLate_s));
    link_->read();  // throws when the joints are no longer read
    std::this_thread::sleep_for(period);
  }
  guard.arrived();
  waitForRest();
}

/// A controller says that it arrived before the arm has swung out, and before the last readings came.
void LiveArm::waitForRest() {
  const auto give_up_at = Clock::now() + Seconds(kLongestRest_s);
  ArmLink::Reading last = link_->read();
  const std::uint64_t first = last.number;
  while (Clock::now() < give_up_at) {
    std::this_thread::sleep_for(Seconds(planner().config().timing.period_s));
    const ArmLink::Reading now = link_->read();
    if (now.number == last.number) continue;
    const bool at_rest = (now.joints - last.joints).cwiseAbs().maxCoeff() < kRest_rad;
    last = now;
    if (at_rest && now.number >= first + 2) return;
  }
  throw DeviceLost(name() + ": does not come to rest");
}

std::unique_ptr<LiveArm> liveArm(const RobotModel& model, const Settings& settings,
                                 std::unique_ptr<ArmLink> link, std::function<std::string()> watch) {
  const JointVector here = link->read().joints;
  Settings here_settings = settings;
  std::vector<double>& start = here_settings.arm.start_rad;
  if (start.empty()) start.assign(here.data(), here.data() + here.size());
  auto planner = startingPlanner(model, here_settings);
  std::vector<JointVector> arc = armStart(*planner, settings.exploration.scan);
  const JointVector wanted = Eigen::Map<const Eigen::VectorXd>(start.data(), here.size());
  if (const double away = (wanted - here).cwiseAbs().maxCoeff(); !(away <= kSameStart_rad))
    throw ArmRefusal(
        fmt::format("a joint stands {:.1f} deg away from arm.start_deg; bring the arm there, or leave "
                    "arm.start_deg out to begin where it stands",
                    away * 180.0 / std::numbers::pi));
  return std::make_unique<LiveArm>(std::move(planner), std::move(arc), std::move(link), std::move(watch));
}

}  // namespace vantage
