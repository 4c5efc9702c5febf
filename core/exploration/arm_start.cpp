#include "core/exploration/arm_start.h"

#include <cmath>
#include <numbers>
#include <string>

namespace vantage {
namespace {

constexpr double kHighest_rad = 85.0 * std::numbers::pi / 180.0;
constexpr double kStep_rad = 5.0 * std::numbers::pi / 180.0;

/// The arc around a configuration; empty, with the reason, if it can't be gone.
std::vector<JointVector> arcAround(const ArmPlanner& arm, const JointVector& start, const ScanConfig& scan,
                                   std::string& reason) {
  std::vector<JointVector> arc;
  for (int f = 0; f < scan.initial_frames; ++f) {
    JointVector q = start;
    if (scan.initial_frames > 1) q[0] += arm.config().start_arc_rad * (f / (scan.initial_frames - 1.0) - 0.5);
    if (!arm.model().withinLimits(q)) {
      reason = "the scan's arc leaves the limits of " + arm.model().joints[0].name;
      return {};
    }
    if (const ArmContact contact = arm.contact(q); !contact.free()) {
      reason = contactText(contact);
      return {};
    }
    if (!arc.empty() && !arm.freeMotion(arc.back(), q)) {
      reason = "the arm would touch something on the scan's arc";
      return {};
    }
    arc.push_back(q);
  }
  return arc;
}

Pose startView(const ScanConfig& scan, double elevation_rad, double roll_rad) {
  const double azimuth = scan.initial_azimuth_rad;
  const Eigen::Vector3d direction(std::cos(elevation_rad) * std::cos(azimuth),
                                  std::cos(elevation_rad) * std::sin(azimuth), std::sin(elevation_rad));
  return lookAt(scan.scene_center_m + scan.initial_distance_m * direction, scan.scene_center_m, roll_rad);
}

}  // namespace

std::vector<JointVector> armStart(const ArmPlanner& arm, const ScanConfig& scan) {
  const int joints = arm.model().jointCount();
  std::string reason = "no configuration puts the camera at a start view";
  if (const std::vector<double>& given = arm.config().start_rad; !given.empty()) {
    if (static_cast<int>(given.size()) != joints)
      throw ArmRefusal("arm.start_deg has " + std::to_string(given.size()) + " values, the arm has " +
                       std::to_string(joints) + " joints; give one a joint");
    const std::vector<JointVector> arc =
        arcAround(arm, Eigen::Map<const Eigen::VectorXd>(given.data(), joints), scan, reason);
    if (arc.empty())
      throw ArmRefusal("arm.start_deg can't be the start: " + reason +
                       "; choose other joints, or vouch for more space with arm.clear_boxes_m");
    return arc;
  }
  const JointVector rest = JointVector::Zero(joints);
  for (double elevation = scan.initial_elevation_rad; elevation <= kHighest_rad; elevation += kStep_rad)
    for (const double roll : {0.0, std::numbers::pi})
      for (const JointVector& q : arm.solutions(startView(scan, elevation, roll), rest))
        if (std::vector<JointVector> arc = arcAround(arm, q, scan, reason); !arc.empty()) return arc;
  throw ArmRefusal("the arm finds no start from which it sees the scene (" + reason +
                   "); give arm.start_deg, or vouch for more space with arm.clear_boxes_m");
}

}  // namespace vantage
