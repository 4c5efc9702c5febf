#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>

#include "hardware/ros_bridge.h"
#include "hardware/ros_topics.h"
#include "hardware/wait_for.h"
#include "io/error.h"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;
using ros_topics::TrajectoryClient;

constexpr double kOpening_s = 5.0;  // nodes have to find us first
constexpr double kCancelling_s = 1.0;

/// The joints of a model out of messages that may each hold some of them.
class JointReader {
 public:
  JointReader(const RobotModel& model, double patience_s) : patience_s_(patience_s) {
    for (const ArmJoint& joint : model.joints) names_.push_back(joint.name);
    reading_.joints = JointVector::Zero(static_cast<Eigen::Index>(names_.size()));
    seen_.assign(names_.size(), false);
  }

  void take(const ros_topics::Joints& message) {
    const std::lock_guard lock(mutex_);
    if (stamp_s_ && !(message.stamp_s > *stamp_s_)) {
      reason_ = fmt::format("the time stamps of its joints stand still at {:.6f} s", *stamp_s_);
      return;
    }
    const std::size_t values = std::min(message.names.size(), message.positions.size());
    bool any = false;
    for (std::size_t i = 0; i < values; ++i) {
      const auto name = std::ranges::find(names_, message.names[i]);
      if (name == names_.end()) continue;
      if (!std::isfinite(message.positions[i])) {
        reason_ = *name + " is read as " + fmt::format("{}", message.positions[i]);
        return;
      }
      const auto j = name - names_.begin();
      reading_.joints[j] = message.positions[i];
      seen_[j] = any = true;
    }
    if (!any) return;
    stamp_s_ = message.stamp_s;
    if (!complete()) return;
    ++reading_.number;
    read_at_ = Clock::now();
    reason_.clear();
    std::fill(seen_.begin(), seen_.end(), false);
  }

  ArmLink::Reading last() const {
    const std::lock_guard lock(mutex_);
    return reading_;
  }
  bool any() const { return last().number > 0; }

  /// What keeps the joints from being read, empty while the last reading is no older than the patience.
  std::string trouble() const {
    const std::lock_guard lock(mutex_);
    const double age_s = std::chrono::duration<double>(Clock::now() - read_at_).count();
    if (reading_.number > 0 && age_s <= patience_s_) return {};
    if (!reason_.empty()) return reason_;
    if (reading_.number > 0) return fmt::format("its joints were not read for {:.1f} s", age_s);
    std::string missing;
    for (std::size_t j = 0; j < names_.size(); ++j)
      if (!seen_[j]) missing += (missing.empty() ? "" : ", ") + names_[j];
    return "no position came of " + missing;
  }

 private:
  bool complete() const { return std::ranges::find(seen_, false) == seen_.end(); }

  const double patience_s_;
  std::vector<std::string> names_;
  mutable std::mutex mutex_;
  ArmLink::Reading reading_;
  std::vector<bool> seen_;  ///< since the last complete reading
  std::optional<double> stamp_s_;
  Clock::time_point read_at_;
  std::string reason_;
};

class RosArmLink : public ArmLink {
 public:
  RosArmLink(const RobotModel& model, const RosArmTopics& topics, double patience_s)
      : name_("arm ros:" + topics.controller), reader_(model, patience_s), client_(topics.controller) {
    for (const ArmJoint& joint : model.joints) joints_.push_back(joint.name);
    subscription_ = ros_topics::subscribeJoints(
        topics.joint_states, [this](const ros_topics::Joints& message) { reader_.take(message); });
    if (!waitFor(kOpening_s, [&] { return client_.connected(); }))
      throw std::runtime_error(
          "no controller answers there; see 'vantage devices' for those that the master knows");
    if (!waitFor(kOpening_s, [&] { return reader_.any(); }))
      throw std::runtime_error(topics.joint_states + ": " + reader_.trouble() +
                               "; is --robot the arm that is there?");
  }

  Reading read() const override {
    if (const std::string lost = reader_.trouble(); !lost.empty()) throw DeviceLost(name_ + ": " + lost);
    return reader_.last();
  }

  void send(const JointTrajectory& trajectory) override {
    std::vector<TrajectoryClient::Point> points;
    for (std::size_t p = 0; p < trajectory.size(); ++p) {
      const JointVector &q = trajectory.positions[p], &v = trajectory.velocities[p];
      points.push_back(
          {trajectory.time_s[p], {q.data(), q.data() + q.size()}, {v.data(), v.data() + v.size()}});
    }
    client_.send(joints_, points);
  }

  Motion motion() override {
    const TrajectoryClient::State state = client_.state();
    if (state == TrajectoryClient::State::Failed)
      failure_ = "the controller gave up the motion: " + client_.failure();
    if (state == TrajectoryClient::State::Moving) return Motion::Moving;
    return failure_.empty() ? Motion::Arrived : Motion::Failed;
  }

  void cancel() override { client_.cancel(kCancelling_s); }

  std::string trouble() const override {
    std::string trouble = failure_;
    if (trouble.empty() && !client_.connected()) trouble = "the controller is gone";
    if (trouble.empty()) trouble = reader_.trouble();
    return trouble.empty() ? trouble : name_ + ": " + trouble;
  }

 private:
  const std::string name_;
  std::vector<std::string> joints_;
  JointReader reader_;
  TrajectoryClient client_;
  std::string failure_;
  ros_topics::Subscription subscription_;  // last: no call comes after it
};

}  // namespace

std::unique_ptr<ArmLink> rosArmLink(const RobotModel& model, const RosArmTopics& topics, double patience_s) {
  try {
    return std::make_unique<RosArmLink>(model, topics, patience_s);
  } catch (const std::runtime_error& error) {
    throw InputError("ros:" + topics.controller, error.what());
  }
}

}  // namespace vantage
