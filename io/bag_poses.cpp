#include "io/bag_poses.h"

// ROS 1 headers are C++17, and so is this file.
#include <geometry_msgs/TransformStamped.h>
#include <tf2/buffer_core.h>
#include <tf2/exceptions.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace vantage::bag {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kFirst = 10 * kSecond;            // tf2 takes time 0 for "the latest"
constexpr std::int64_t kLast = 2'000'000'000 * kSecond;  // with the cache's length within 32 bits of seconds
constexpr std::int64_t kAhead = 5 * kSecond;             // what a lookup may need beyond its own time

/// Frames on the way up from the given ones, these included.
std::set<std::string> ancestors(const TransformLog& log, std::set<std::string> frames) {
  std::multimap<std::string, std::string> parents;
  std::set<std::pair<std::string, std::string>> known;
  for (const auto* transforms : {&log.fixed, &log.moving})
    for (const Transform& transform : *transforms)
      if (known.emplace(transform.child, transform.parent).second)
        parents.emplace(transform.child, transform.parent);
  for (std::vector<std::string> open(frames.begin(), frames.end()); !open.empty();) {
    const std::string frame = open.back();
    open.pop_back();
    const auto [first, last] = parents.equal_range(frame);
    for (auto parent = first; parent != last; ++parent)
      if (frames.insert(parent->second).second) open.push_back(parent->second);
  }
  return frames;
}

/// The moving transforms that matter in ascending time, one for each child and time (tf2 would complain).
std::vector<const Transform*> inTime(const TransformLog& log, const std::set<std::string>& children) {
  std::vector<const Transform*> sorted;
  for (const Transform& transform : log.moving)
    if (children.count(transform.child) > 0) sorted.push_back(&transform);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Transform* a, const Transform* b) {
    return std::tie(a->stamp_ns, a->child) < std::tie(b->stamp_ns, b->child);
  });
  const auto same = [](const Transform* a, const Transform* b) {
    return a->stamp_ns == b->stamp_ns && a->child == b->child;
  };
  sorted.erase(std::unique(sorted.begin(), sorted.end(), same), sorted.end());
  return sorted;
}

/// tf2's buffer with times that count from the first transform.
class Buffer {
 public:
  explicit Buffer(std::int64_t start_ns)
      : start_ns_(start_ns), buffer_(ros::Duration(static_cast<std::int32_t>(kLast / kSecond), 0)) {}

  void add(const Transform& transform, bool is_static) {
    if (!is_static && transform.stamp_ns - start_ns_ > kLast - kFirst) return;
    geometry_msgs::TransformStamped message;
    message.header.stamp = is_static ? ros::Time(1, 0) : timeOf(transform.stamp_ns);
    message.header.frame_id = transform.parent;
    message.child_frame_id = transform.child;
    const Eigen::Vector3d p = transform.T_parent_child.translation();
    const Eigen::Quaterniond q = orientationOf(transform.T_parent_child);
    message.transform.translation.x = p.x();
    message.transform.translation.y = p.y();
    message.transform.translation.z = p.z();
    message.transform.rotation.x = q.x();
    message.transform.rotation.y = q.y();
    message.transform.rotation.z = q.z();
    message.transform.rotation.w = q.w();
    buffer_.setTransform(message, "bag", is_static);
  }

  std::optional<Pose> find(const std::string& fixed_frame, const FrameTime& wanted) const {
    try {
      const auto message = buffer_.lookupTransform(fixed_frame, wanted.frame, timeOf(wanted.stamp_ns));
      const auto& t = message.transform.translation;
      const auto& r = message.transform.rotation;
      return makePose({t.x, t.y, t.z}, Eigen::Quaterniond(r.w, r.x, r.y, r.z));
    } catch (const tf2::TransformException&) {
      return std::nullopt;
    }
  }

 private:
  ros::Time timeOf(std::int64_t stamp_ns) const {
    ros::Time time;
    return time.fromNSec(static_cast<std::uint64_t>(
        std::clamp<std::int64_t>(stamp_ns - start_ns_ + kFirst, 1, kLast + kFirst)));
  }

  std::int64_t start_ns_;
  tf2::BufferCore buffer_;
};

}  // namespace

void TransformLog::add(std::vector<Transform> transforms, bool is_static) {
  for (Transform& transform : transforms) {
    if (transform.usable)
      (is_static ? fixed : moving).push_back(std::move(transform));
    else
      ++unusable;
  }
}

std::vector<std::string> TransformLog::frames() const {
  std::set<std::string> names;
  for (const auto* transforms : {&fixed, &moving})
    for (const Transform& transform : *transforms) names.insert({transform.parent, transform.child});
  return {names.begin(), names.end()};
}

std::string rootOf(const TransformLog& log, const std::string& frame) {
  std::map<std::string, std::string> parent_of;
  for (const auto* transforms : {&log.fixed, &log.moving})
    for (const Transform& transform : *transforms) parent_of[transform.child] = transform.parent;
  std::string root = frame;
  for (std::size_t steps = 0; parent_of.count(root) > 0; ++steps) {
    if (steps > parent_of.size()) return {};
    root = parent_of.at(root);
  }
  return root;
}

std::vector<std::optional<Pose>> posesAt(const TransformLog& log, const std::string& fixed_frame,
                                         const std::vector<FrameTime>& wanted) {
  std::set<std::string> ends{fixed_frame};
  for (const FrameTime& entry : wanted) ends.insert(entry.frame);
  const std::set<std::string> children = ancestors(log, std::move(ends));
  const std::vector<const Transform*> moving = inTime(log, children);
  Buffer buffer(moving.empty() ? 0 : moving.front()->stamp_ns);
  for (const Transform& transform : log.fixed)
    if (children.count(transform.child) > 0) buffer.add(transform, true);

  // tf2 searches from its latest entry back: it is given what lies a little ahead, then all.
  std::vector<std::size_t> order(wanted.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return wanted[a].stamp_ns < wanted[b].stamp_ns; });
  std::vector<std::optional<Pose>> poses(wanted.size());
  std::size_t next = 0;
  for (const std::size_t i : order) {
    for (; next < moving.size() && moving[next]->stamp_ns <= wanted[i].stamp_ns + kAhead; ++next)
      buffer.add(*moving[next], false);
    poses[i] = buffer.find(fixed_frame, wanted[i]);
  }
  for (; next < moving.size(); ++next) buffer.add(*moving[next], false);
  for (const std::size_t i : order)
    if (!poses[i]) poses[i] = buffer.find(fixed_frame, wanted[i]);
  return poses;
}

}  // namespace vantage::bag
