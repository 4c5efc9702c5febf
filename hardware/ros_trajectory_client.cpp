#include <actionlib/client/simple_action_client.h>
#include <control_msgs/FollowJointTrajectoryAction.h>
#include <fmt/format.h>

#include <utility>

#include "hardware/ros_node.h"
#include "hardware/ros_topics.h"

namespace vantage::ros_topics {

struct TrajectoryClient::Client {
  explicit Client(const std::string& action) : actions(node(), action, false) {}
  actionlib::SimpleActionClient<control_msgs::FollowJointTrajectoryAction> actions;
  bool sent = false;  ///< a motion that has not ended, as far as we know
};

TrajectoryClient::TrajectoryClient(const std::string& action) : client_(std::make_unique<Client>(action)) {}

TrajectoryClient::~TrajectoryClient() {
  if (client_->sent) client_->actions.cancelGoal();
}

bool TrajectoryClient::connected() const {
  return client_->actions.isServerConnected();
}

void TrajectoryClient::send(const std::vector<std::string>& joints, const std::vector<Point>& points) {
  control_msgs::FollowJointTrajectoryGoal goal;
  goal.trajectory.joint_names = joints;
  for (const Point& point : points) {
    trajectory_msgs::JointTrajectoryPoint message;
    message.positions = point.positions;
    message.velocities = point.velocities;
    message.time_from_start = ros::Duration(point.time_s);
    goal.trajectory.points.push_back(std::move(message));
  }
  client_->actions.sendGoal(goal);
  client_->sent = true;
}

TrajectoryClient::State TrajectoryClient::state() {
  const actionlib::SimpleClientGoalState state = client_->actions.getState();
  if (!state.isDone()) return State::Moving;
  client_->sent = state == actionlib::SimpleClientGoalState::LOST;  // then the controller may still be moving
  return state == actionlib::SimpleClientGoalState::SUCCEEDED ? State::Succeeded : State::Failed;
}

std::string TrajectoryClient::failure() {
  const auto result = client_->actions.getResult();
  std::string text = client_->actions.getState().toString();
  if (result) text += fmt::format(", error code {}", result->error_code);
  if (result && !result->error_string.empty()) text += ", " + result->error_string;
  return text;
}

void TrajectoryClient::cancel(double wait_s) {
  if (!client_->sent) return;
  client_->actions.cancelGoal();
  client_->actions.waitForResult(ros::Duration(wait_s));
  client_->sent = false;
}

}  // namespace vantage::ros_topics
