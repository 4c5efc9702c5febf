#include <console_bridge/console.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <mutex>
#include <set>
#include <string>

#include "core/motion/robot_model.h"

namespace vantage {
namespace {

/// Keeps what urdfdom says while it reads, instead of printing it. Its handler belongs to the process, so
/// only one reader at a time.
class ParserMessages : public console_bridge::OutputHandler {
 public:
  ParserMessages() : lock_(mutex()) { console_bridge::useOutputHandler(this); }
  ~ParserMessages() override { console_bridge::restorePreviousOutputHandler(); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_error_.empty()) first_error_ = text;
  }
  const std::string& firstError() const { return first_error_; }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  std::lock_guard<std::mutex> lock_;
  std::string first_error_;
};

[[noreturn]] void refuse(const std::string& what) {
  throw RobotModelError(what);
}

std::string quoted(const std::string& name) {
  return "'" + name + "'";
}

/// No arm has longer parts; what is longer is a mistake, and would make maps without bound around it.
bool plausible(double length_m) {
  constexpr double kLongest_m = 100.0;
  return length_m <= kLongest_m;
}
[[noreturn]] void refuseSize(const std::string& what, double length_m) {
  refuse(what + " is " + std::to_string(length_m) +
         " m; allowed: up to 100 m (are lengths or meshes in millimetres? a mesh takes scale=\"0.001 0.001 "
         "0.001\")");
}

Eigen::Vector3d vectorOf(const urdf::Vector3& v) {
  return {v.x, v.y, v.z};
}

Pose poseOf(const urdf::Pose& pose, const std::string& where) {
  const Eigen::Vector3d position = vectorOf(pose.position);
  const Eigen::Quaterniond rotation(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
  if (!position.allFinite() || !rotation.coeffs().allFinite())
    refuse(where + ": its origin is not finite; give numbers for xyz and rpy");
  if (!plausible(position.cwiseAbs().maxCoeff())) refuseSize(where + ": its origin", position.norm());
  return makePose(position, rotation);
}

urdf::ModelInterfaceSharedPtr parsed(const std::string& text) {
  ParserMessages messages;
  urdf::ModelInterfaceSharedPtr model;
  std::string reason;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (!messages.firstError().empty()) reason = messages.firstError();
  if (reason.find("No root link") != std::string::npos)
    reason = "there is no root link: every link hangs on another one; an arm is a tree";
  while (!reason.empty() && std::isspace(static_cast<unsigned char>(reason.back()))) reason.pop_back();
  if (!model || !model->getRoot() || !reason.empty())
    refuse("is no arm: " + (reason.empty() ? "no URDF was found" : reason));
  return model;
}

int linksBelow(const urdf::Link& link) {
  int count = 1;
  for (const auto& child : link.child_links) count += linksBelow(*child);
  return count;
}

/// A tree: every link has one parent joint and hangs on the root.
void requireTree(const urdf::ModelInterface& model) {
  std::set<std::string> children;
  for (const auto& [name, joint] : model.joints_)
    if (!children.insert(joint->child_link_name).second)
      refuse("link " + quoted(joint->child_link_name) +
             " hangs on several joints: the links form a loop; an arm is a tree");
  if (linksBelow(*model.getRoot()) != static_cast<int>(model.links_.size()))
    refuse("some links form a loop and do not hang on " + quoted(model.getRoot()->name) +
           "; an arm is a tree with one root");
}

bool moves(const urdf::Joint& joint) {
  return joint.type != urdf::Joint::FIXED;
}

std::string leafLinks(const urdf::ModelInterface& model) {
  std::string names;
  for (const auto& [name, link] : model.links_)
    if (link->child_joints.empty()) names += (names.empty() ? "" : ", ") + name;
  return names;
}

/// Joints from the root to the camera.
std::vector<urdf::JointConstSharedPtr> chainTo(const urdf::ModelInterface& model, const std::string& camera) {
  urdf::LinkConstSharedPtr link = model.getLink(camera);
  if (!link)
    refuse("has no link " + quoted(camera) + "; name the camera's link (the last ones: " + leafLinks(model) +
           ")");
  std::vector<urdf::JointConstSharedPtr> chain;
  while (link->parent_joint) {
    chain.push_back(link->parent_joint);
    link = model.getLink(link->parent_joint->parent_link_name);
  }
  std::reverse(chain.begin(), chain.end());
  return chain;
}

void setLimits(ArmJoint& arm, const urdf::Joint& joint) {
  const std::string where = "joint " + quoted(joint.name);
  if (!joint.limits) refuse(where + " has no limits; add <limit lower= upper= velocity= effort=/>");
  arm.max_velocity = joint.limits->velocity;
  if (!(std::isfinite(arm.max_velocity) && arm.max_velocity > 0.0))
    refuse(where + ": its velocity limit is " + std::to_string(arm.max_velocity) + "; allowed: more than 0");
  if (joint.type == urdf::Joint::CONTINUOUS) return;
  arm.lower = joint.limits->lower;
  arm.upper = joint.limits->upper;
  if (!std::isfinite(arm.lower) || !std::isfinite(arm.upper) || arm.lower >= arm.upper)
    refuse(where + ": its limits are " + std::to_string(arm.lower) + " .. " + std::to_string(arm.upper) +
           "; the lower one has to lie below the upper one");
  const double travel = std::max(std::abs(arm.lower), std::abs(arm.upper));
  if (joint.type == urdf::Joint::PRISMATIC && !plausible(travel)) refuseSize(where + ": its travel", travel);
}

ArmJoint armJoint(const urdf::Joint& joint) {
  const std::string where = "joint " + quoted(joint.name);
  ArmJoint arm;
  arm.name = joint.name;
  if (joint.type == urdf::Joint::PRISMATIC)
    arm.prismatic = true;
  else if (joint.type != urdf::Joint::REVOLUTE && joint.type != urdf::Joint::CONTINUOUS)
    refuse(where +
           " moves in several directions at once; only revolute, continuous and prismatic joints can "
           "carry a camera");
  if (joint.mimic) refuse(where + " mimics another one; joints between base and camera move by themselves");
  arm.axis = vectorOf(joint.axis);
  if (!arm.axis.allFinite() || arm.axis.norm() < 1e-9) refuse(where + " has an axis without direction");
  arm.axis.normalize();
  setLimits(arm, joint);
  return arm;
}

/// A joint beside the chain, e.g. of a gripper, at 0 or its nearest limit.
Pose restMotion(const urdf::Joint& joint) {
  const bool sliding = joint.type == urdf::Joint::PRISMATIC;
  if ((!sliding && joint.type != urdf::Joint::REVOLUTE) || joint.mimic || !joint.limits)
    return Pose::Identity();
  const double rest = std::max(joint.limits->lower, std::min(0.0, joint.limits->upper));
  const Eigen::Vector3d axis = vectorOf(joint.axis);
  if (!std::isfinite(rest) || !axis.allFinite() || axis.norm() < 1e-9) return Pose::Identity();
  ArmJoint arm;
  arm.prismatic = sliding;
  arm.axis = axis.normalized();
  return jointMotion(arm, rest);
}

double positive(double value, const std::string& what) {
  if (std::isfinite(value) && value > 0.0) {
    if (!plausible(value)) refuseSize(what, value);
    return value;
  }
  refuse(what + " = " + std::to_string(value) + "; allowed: more than 0");
}

/// \param T_frame_link of the link that the shape belongs to.
LinkShape linkShape(const urdf::Link& link, const urdf::Collision& body, const Pose& T_frame_link, int frame,
                    const MeshBounds& mesh_bounds) {
  const std::string where = "link " + quoted(link.name);
  if (!body.geometry) refuse(where + " has a collision body without geometry");
  LinkShape shape;
  shape.link = link.name;
  shape.frame = frame;
  shape.T_frame_shape = T_frame_link * poseOf(body.origin, where);
  switch (body.geometry->type) {
    case urdf::Geometry::BOX: {
      const auto& dim = static_cast<const urdf::Box&>(*body.geometry).dim;
      shape.size_m = {positive(dim.x, where + ": box size"), positive(dim.y, where + ": box size"),
                      positive(dim.z, where + ": box size")};
      break;
    }
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(*body.geometry);
      shape.kind = ShapeKind::Cylinder;
      shape.radius_m = positive(cylinder.radius, where + ": cylinder radius");
      shape.length_m = positive(cylinder.length, where + ": cylinder length");
      break;
    }
    case urdf::Geometry::SPHERE:
      shape.kind = ShapeKind::Sphere;
      shape.radius_m =
          positive(static_cast<const urdf::Sphere&>(*body.geometry).radius, where + ": sphere radius");
      break;
    case urdf::Geometry::MESH: {
      const auto& mesh = static_cast<const urdf::Mesh&>(*body.geometry);
      if (!mesh_bounds) refuse(where + ": its mesh " + quoted(mesh.filename) + " cannot be read here");
      Box box;
      try {
        box = mesh_bounds(mesh.filename);
      } catch (const std::exception& error) {
        refuse(where + ": its mesh " + quoted(mesh.filename) + " cannot be read: " + error.what());
      }
      const Eigen::Vector3d scale = vectorOf(mesh.scale);
      if (!scale.allFinite() || (scale.array() == 0.0).any()) refuse(where + ": its mesh has a scale of 0");
      const double size_m = scale.cwiseAbs().cwiseProduct(box.sizes() / 2 + box.center().cwiseAbs()).norm();
      if (!plausible(size_m)) refuseSize(where + ": its mesh " + quoted(mesh.filename), size_m);
      shape.T_frame_shape = shape.T_frame_shape * Eigen::Translation3d(scale.cwiseProduct(box.center()));
      shape.size_m = scale.cwiseAbs().cwiseProduct(box.sizes()).cwiseMax(1e-6);
      break;
    }
  }
  return shape;
}

/// The two ends of a cylinder's axis.
std::pair<Eigen::Vector3d, Eigen::Vector3d> endsOf(const LinkShape& cylinder) {
  const Eigen::Vector3d half = cylinder.T_frame_shape.linear().col(2) * (cylinder.length_m / 2);
  return {cylinder.T_frame_shape.translation() - half, cylinder.T_frame_shape.translation() + half};
}

/// URDF has no capsules; they are written as a cylinder with a sphere at each end.
void joinCapsules(std::vector<LinkShape>& shapes) {
  const auto sphereAt = [&](const Eigen::Vector3d& p, double radius_m) {
    return std::find_if(shapes.begin(), shapes.end(), [&](const LinkShape& s) {
      return s.kind == ShapeKind::Sphere && std::abs(s.radius_m - radius_m) < 1e-6 &&
             (s.T_frame_shape.translation() - p).norm() < 1e-6;
    });
  };
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    constexpr double kShortest_m = 1e-5;  // below it both ends would be one sphere
    if (shapes[i].kind != ShapeKind::Cylinder || shapes[i].length_m < kShortest_m) continue;
    const LinkShape cylinder = shapes[i];
    const auto [low, high] = endsOf(cylinder);
    if (sphereAt(low, cylinder.radius_m) == shapes.end() || sphereAt(high, cylinder.radius_m) == shapes.end())
      continue;
    shapes[i].kind = ShapeKind::Capsule;
    for (const Eigen::Vector3d& end : {low, high}) shapes.erase(sphereAt(end, cylinder.radius_m));
    i = static_cast<std::size_t>(-1);  // places have moved; what is a capsule now is passed over
  }
}

/// Reads the tree from the root on and keeps what the arm needs.
class ArmReader {
 public:
  ArmReader(const std::vector<urdf::JointConstSharedPtr>& chain, const std::string& camera_link,
            const MeshBounds& mesh_bounds, RobotModel& model)
      : mesh_bounds_(mesh_bounds), model_(model) {
    for (const auto& joint : chain) chain_.insert(joint->name);
    model_.camera_link = camera_link;
  }

  /// A link whose pose in the frame of joint `frame` is known, and everything that hangs on it.
  void visit(const urdf::Link& link, const Pose& T_frame_link, int frame) {
    if (link.name == model_.camera_link) model_.T_tip_camera = T_frame_link;
    std::vector<LinkShape> shapes;
    for (const auto& body : link.collision_array)
      if (body) shapes.push_back(linkShape(link, *body, T_frame_link, frame, mesh_bounds_));
    joinCapsules(shapes);
    model_.shapes.insert(model_.shapes.end(), shapes.begin(), shapes.end());
    for (std::size_t i = 0; i < link.child_joints.size(); ++i)
      follow(*link.child_joints[i], *link.child_links[i], T_frame_link, frame);
  }

 private:
  void follow(const urdf::Joint& joint, const urdf::Link& child, const Pose& T_frame_link, int frame) {
    const Pose T_frame_joint =
        T_frame_link * poseOf(joint.parent_to_joint_origin_transform, "joint " + quoted(joint.name));
    if (!moves(joint)) return visit(child, T_frame_joint, frame);
    if (!chain_.contains(joint.name)) return visit(child, T_frame_joint * restMotion(joint), frame);
    ArmJoint arm = armJoint(joint);
    if (model_.jointCount() == kMaxArmJoints)
      refuse("has more than " + std::to_string(kMaxArmJoints) + " moving joints before the camera");
    arm.T_parent_joint = T_frame_joint;
    model_.joints.push_back(std::move(arm));
    visit(child, Pose::Identity(), model_.jointCount() - 1);
  }

  const MeshBounds& mesh_bounds_;
  RobotModel& model_;
  std::set<std::string> chain_;
};

}  // namespace

RobotModel parseUrdf(const std::string& text, const std::string& camera_link, const MeshBounds& mesh_bounds) {
  const urdf::ModelInterfaceSharedPtr tree = parsed(text);
  requireTree(*tree);
  const std::string camera = camera_link.empty() ? std::string(kCameraLink) : camera_link;
  RobotModel model;
  model.name = tree->getName();
  ArmReader(chainTo(*tree, camera), camera, mesh_bounds, model).visit(*tree->getRoot(), Pose::Identity(), -1);
  if (model.joints.empty()) refuse("no joint moves between the base and " + quoted(camera));
  return model;
}

}  // namespace vantage
