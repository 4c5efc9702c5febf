#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hardware/arm.h"
#include "io/config_file.h"

namespace vantage {

/// What a live arm needs of the software that drives its motors. Called from one thread.
class ArmLink {
 public:
  virtual ~ArmLink() = default;
  enum class Motion { Moving, Arrived, Failed };
  /// A reading of all joints.
  struct Reading {
    JointVector joints;        ///< rad or m
    std::uint64_t number = 0;  ///< counts the readings
  };

  /// The last complete reading. \throws DeviceLost if it is too old or no numbers come
  virtual Reading read() const = 0;
  /// Begins a motion; returns at once.
  virtual void send(const JointTrajectory& trajectory) = 0;
  /// Of the motion that was sent last.
  virtual Motion motion() = 0;
  /// Ends the motion; the arm brakes at once.
  virtual void cancel() = 0;
  /// Why the last motion failed, or why the link is no longer one; empty if nothing is wrong.
  virtual std::string trouble() const = 0;
};

/// An arm that truly moves. Stops it when the exploration is to stop, when its joints are no longer read, and
/// when something else that it needs is lost.
class LiveArm : public Arm {
 public:
  /// \param watch says what else was lost, e.g. the camera; empty text if nothing
  LiveArm(std::unique_ptr<ArmPlanner> planner, std::vector<JointVector> start, std::unique_ptr<ArmLink> link,
          std::function<std::string()> watch);

 protected:
  JointVector joints() const override { return link_->read().joints; }
  /// Looks at everything once in a control period. \throws Cancelled, DeviceLost: the motion was cancelled
  void follow(const JointTrajectory& trajectory, const RunControl& control) override;

 private:
  std::string trouble() const;
  void waitForRest();

  std::unique_ptr<ArmLink> link_;
  std::function<std::string()> watch_;
};

/// Live arm where it stands now, in a map in which all is unknown: its initial scan turns the first joint
/// around that. \throws ArmRefusal if it stands where it must not, or not where arm.start_deg says;
/// std::invalid_argument as startingPlanner()
std::unique_ptr<LiveArm> liveArm(const RobotModel& model, const Settings& settings,
                                 std::unique_ptr<ArmLink> link, std::function<std::string()> watch);

}  // namespace vantage
