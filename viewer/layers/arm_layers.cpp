// The arm that carries the camera: where it stands, how it moves, and the space that is vouched for.
#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkProperty.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "viewer/layers/layer.h"
#include "viewer/layers/shapes.h"

namespace vantage {
namespace {

using Mark = LegendEntry::Mark;

constexpr int kSides = 24;  // of a round body
constexpr int kRings = 6;   // of half a ball
constexpr int kGhosts = 5;  // between start and end of a motion

/// Smooth triangles of bodies, world.
struct BodyMesh {
  std::vector<Eigen::Vector3f> points, normals;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  void addPoint(const Pose& pose, const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
    points.push_back((pose * p).cast<float>());
    normals.push_back((pose.linear() * normal).cast<float>());
  }
};

/// A point of an outline that turns about z: radius, height, and the normal there.
struct OutlinePoint {
  double r, z, normal_r, normal_z;
};

void addTurned(BodyMesh& mesh, const Pose& pose, const std::vector<OutlinePoint>& outline) {
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  for (const OutlinePoint& o : outline)
    for (int s = 0; s <= kSides; ++s) {
      const double angle = 2.0 * std::numbers::pi * s / kSides, c = std::cos(angle), n = std::sin(angle);
      mesh.addPoint(pose, {o.r * c, o.r * n, o.z}, {o.normal_r * c, o.normal_r * n, o.normal_z});
    }
  const auto at = [&](std::size_t ring, int side) {
    return first + static_cast<std::uint32_t>(ring * (kSides + 1)) + static_cast<std::uint32_t>(side);
  };
  for (std::size_t ring = 0; ring + 1 < outline.size(); ++ring)
    for (int s = 0; s < kSides; ++s) {
      mesh.triangles.push_back({at(ring, s), at(ring, s + 1), at(ring + 1, s)});
      mesh.triangles.push_back({at(ring + 1, s), at(ring, s + 1), at(ring + 1, s + 1)});
    }
}

/// Half balls at both ends of a straight part, from below.
std::vector<OutlinePoint> capsuleOutline(double radius, double length) {
  std::vector<OutlinePoint> outline;
  for (int half : {-1, 1})
    for (int ring = 0; ring <= kRings; ++ring) {
      const double up = std::numbers::pi / 2 * (half < 0 ? ring - kRings : ring) / kRings;
      outline.push_back(
          {radius * std::cos(up), half * length / 2 + radius * std::sin(up), std::cos(up), std::sin(up)});
    }
  return outline;
}

std::vector<OutlinePoint> cylinderOutline(double r, double length) {
  const double h = length / 2;
  return {{0, -h, 0, -1}, {r, -h, 0, -1}, {r, -h, 1, 0}, {r, h, 1, 0}, {r, h, 0, 1}, {0, h, 0, 1}};
}

void addCuboid(BodyMesh& mesh, const Pose& pose, const Eigen::Vector3d& size) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const auto first = static_cast<std::uint32_t>(mesh.points.size());
      const Eigen::Vector3d normal = side * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d u = Eigen::Vector3d::Unit((axis + 1) % 3),
                            v = side * Eigen::Vector3d::Unit((axis + 2) % 3);
      for (const auto& [a, b] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
        mesh.addPoint(pose, (0.5 * size).cwiseProduct(normal + a * u + b * v), normal);
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
}

/// All bodies of an arm in a configuration, or those that move.
BodyMesh meshOf(const ArmHeader& arm, const JointVector& q, bool with_base) {
  BodyMesh mesh;
  const ArmFrames frames = forwardKinematics(arm.model, q);
  for (const LinkShape& shape : arm.model.shapes) {
    if (shape.frame < 0 && !with_base) continue;
    const Pose pose = arm.T_world_base * frames.of(shape.frame) * shape.T_frame_shape;
    switch (shape.kind) {
      case ShapeKind::Cuboid:
        addCuboid(mesh, pose, shape.size_m);
        break;
      case ShapeKind::Cylinder:
        addTurned(mesh, pose, cylinderOutline(shape.radius_m, shape.length_m));
        break;
      case ShapeKind::Capsule:
      case ShapeKind::Sphere:
        addTurned(mesh, pose, capsuleOutline(shape.radius_m, shape.length_m));
        break;
    }
  }
  return mesh;
}

vtkSmartPointer<vtkActor> armActor(const BodyMesh& mesh, Rgb color, double opacity) {
  return triangleActor(mesh.points, mesh.normals, mesh.triangles, {}, color, opacity);
}

void mustSee(const BodyMesh& mesh, LayerContent& content) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : mesh.points) box.extend(p);
  for (int corner = 0; corner < 8; ++corner)
    content.must_see.push_back(
        box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner)).cast<double>());
}

/// "12° -34° ...", millimetres for joints that slide.
std::string jointText(const RobotModel& model, const JointVector& q) {
  std::string text;
  for (int i = 0; i < model.jointCount(); ++i) {
    if (i > 0) text += "  ";
    text += model.joints[i].prismatic ? fmt::format("{:.0f} mm", q[i] * 1e3)
                                      : fmt::format("{:.0f}°", q[i] * 180.0 / std::numbers::pi);
  }
  return text;
}

bool fits(const SceneFrame& frame, const JointVector& q) {
  return frame.header.arm && q.size() == frame.header.arm->model.jointCount();
}

}  // namespace

LayerContent armLayer(const SceneFrame& frame, const LayerStyle&) {
  LayerContent content;
  if (!frame.record.joints || frame.record.joints->empty()) return content;
  const JointVector& q = frame.record.joints->back();
  if (!fits(frame, q)) return content;
  const BodyMesh mesh = meshOf(*frame.header.arm, q, true);
  content.props.push_back(armActor(mesh, palette::kArm, 1.0));
  mustSee(mesh, content);
  content.legend.push_back(
      {Mark::Fill, palette::kArm, 1.0, "arm after the scan: " + jointText(frame.header.arm->model, q)});
  return content;
}

LayerContent armMotionLayer(const SceneFrame& frame, const LayerStyle&) {
  LayerContent content;
  const JointTrajectory* trajectory = frame.record.trajectory.get();
  if (!trajectory || trajectory->size() == 0 || !fits(frame, trajectory->positions.front())) return content;
  const ArmHeader& arm = *frame.header.arm;
  for (int ghost = 1; ghost <= kGhosts; ++ghost) {
    const double time_s = trajectory->duration_s() * ghost / (kGhosts + 1);
    const auto later = std::ranges::lower_bound(trajectory->time_s, time_s);
    const auto point = static_cast<std::size_t>(later - trajectory->time_s.begin());
    content.props.push_back(
        armActor(meshOf(arm, trajectory->positions[point], false), palette::kArmGhost, 0.12));
  }
  const JointVector& goal = trajectory->positions.back();
  const BodyMesh end = meshOf(arm, goal, false);
  content.props.push_back(armActor(end, palette::kArmGoal, 0.45));
  mustSee(end, content);
  content.legend.push_back(
      {Mark::Fill, palette::kArmGoal, 0.6, "arm at the chosen view: " + jointText(arm.model, goal)});
  content.legend.push_back({Mark::Fill, palette::kArmGhost, 0.3,
                            fmt::format("on its way there, {:.1f} s", trajectory->duration_s())});
  return content;
}

LayerContent clearBoxesLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  if (!frame.header.arm) return content;
  LineSet lines;
  for (const Box& box : frame.header.arm->clear_boxes) addBox(lines, box);
  content.props.push_back(lineActor(lines, palette::kFree, 1.5 * style.line_scale));
  content.legend.push_back({Mark::Line, palette::kFree, 1.0, "space that is vouched to be free"});
  return content;
}

}  // namespace vantage
