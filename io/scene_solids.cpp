#include "io/scene_solids.h"

#include <cctype>
#include <filesystem>
#include <numbers>

#include "io/error.h"
#include "io/mesh_file.h"
#include "io/suggest.h"

namespace vantage {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

const std::vector<std::string> kKinds = {"box",   "sphere", "cylinder", "cone",
                                         "torus", "lathe",  "sweep",    "mesh"};

double radians(double degrees) {
  return degrees * std::numbers::pi / 180.0;
}
Vector3d vector3(const std::vector<double>& v) {
  return {v[0], v[1], v[2]};
}

Solid::Color readColor(const SceneTable& table, const std::string& text) {
  const bool hex =
      text.size() == 7 && text[0] == '#' &&
      std::all_of(text.begin() + 1, text.end(), [](unsigned char c) { return std::isxdigit(c); });
  if (!hex) table.fail("color", "'color' is '" + text + "'; give '#rrggbb'");
  Solid::Color color;
  for (std::size_t i = 0; i < 3; ++i)
    color[i] = static_cast<std::uint8_t>(std::stoi(text.substr(1 + 2 * i, 2), nullptr, 16));
  return color;
}

Pose readPose(SceneTable& table) {
  Pose pose = Pose::Identity();
  if (table.has("position_m")) pose.translation() = vector3(table.numbers("position_m", 3));
  if (table.has("yaw_deg") && table.has("rpy_deg"))
    table.fail("yaw_deg", "'yaw_deg' and 'rpy_deg' exclude each other; give one");
  if (table.has("rpy_deg")) {
    const Vector3d rpy = vector3(table.numbers("rpy_deg", 3));
    pose.linear() =
        (AngleAxisd(radians(rpy.z()), Vector3d::UnitZ()) * AngleAxisd(radians(rpy.y()), Vector3d::UnitY()) *
         AngleAxisd(radians(rpy.x()), Vector3d::UnitX()))
            .toRotationMatrix();
  }
  const double yaw = radians(table.number("yaw_deg", 0.0));
  if (yaw != 0.0) pose.linear() = AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

ShapePtr readLathe(SceneTable& table) {
  std::vector<ProfilePoint> profile;
  for (const auto& p : table.points("profile_m", 2)) profile.emplace_back(p[0], p[1]);
  const bool smooth = table.flag("smooth", false);
  if (table.has("thickness_m")) return makeLatheShell(profile, table.number("thickness_m"), smooth);
  return makeLathe(profile, smooth);
}

ShapePtr readSweep(SceneTable& table) {
  std::vector<Vector3d> path;
  for (const auto& p : table.points("path_m", 3)) path.push_back(vector3(p));
  return makeSweep(path, table.number("radius_m"));
}

ShapePtr readMesh(SceneTable& table, const std::string& folder) {
  std::filesystem::path path = table.text("file");
  if (path.is_relative()) path = std::filesystem::path(folder) / path;
  const double scale = table.number("scale", 1.0);
  if (scale <= 0) table.fail("scale", "'scale' is " + std::to_string(scale) + "; give a number above 0");
  TriangleMesh mesh = loadMesh(path.string());
  for (Eigen::Vector3f& v : mesh.vertices) v *= static_cast<float>(scale);
  return makeMeshShape(std::move(mesh));
}

ShapePtr readShape(SceneTable& table, const std::string& kind, const std::string& folder) {
  if (kind == "box") return makeBox(vector3(table.numbers("size_m", 3)));
  if (kind == "sphere") return makeSphere(table.number("radius_m"));
  if (kind == "cylinder") {
    const double radius = table.number("radius_m");
    return makeCone(radius, radius, table.number("height_m"));
  }
  if (kind == "cone") {
    const double bottom = table.number("radius_bottom_m"), top = table.number("radius_top_m");
    return makeCone(bottom, top, table.number("height_m"));
  }
  if (kind == "torus") {
    const double radius = table.number("radius_m"), tube = table.number("tube_radius_m");
    return makeTorus(radius, tube, radians(table.number("angle_deg", 360.0)));
  }
  if (kind == "lathe") return readLathe(table);
  if (kind == "sweep") return readSweep(table);
  if (kind == "mesh") return readMesh(table, folder);
  table.fail("kind", "unknown kind '" + kind + "'" + suggestion(kind, kKinds));
}

/// Colours told apart by colour-blind readers too (Okabe & Ito).
std::string defaultColor(std::size_t number) {
  constexpr std::array<const char*, 7> colors = {"#e69f00", "#0072b2", "#009e73", "#d55e00",
                                                 "#56b4e9", "#cc79a7", "#f0e442"};
  return colors[number % colors.size()];
}

Solid slab(const Vector3d& low, const Vector3d& high, Solid::Color color) {
  Pose pose = Pose::Identity();
  pose.translation() = Vector3d((low.x() + high.x()) / 2, (low.y() + high.y()) / 2, low.z());
  return Solid(makeBox(high - low), pose, SolidRole::Room, "room", color);
}

}  // namespace

void completeSolid(toml::table& solid, std::size_t number) {
  const std::optional<std::string> kind = solid["kind"].value<std::string>();
  if (kind) solid.insert("object", *kind + " " + std::to_string(number));
  solid.insert("color", defaultColor(number - 1));
}

Solid readSolid(SceneTable& table, const std::string& folder) {
  const std::string kind = table.text("kind"), object = table.text("object");
  table.setWhat("solid (" + object + ")");
  const std::string role_name = table.text("role", "object");
  const std::optional<SolidRole> role = solidRole(role_name);
  if (!role) {
    const std::vector<std::string> roles = {"object", "table", "panel", "room", "other"};
    table.fail("role", "unknown role '" + role_name + "'" + suggestion(role_name, roles));
  }
  const Solid::Color color = readColor(table, table.text("color"));
  const Pose pose = readPose(table);
  ShapePtr shape;
  try {
    shape = readShape(table, kind, folder);
  } catch (const std::invalid_argument& error) {
    table.fail("kind", error.what());
  }
  table.finish();
  return Solid(shape, pose, *role, object, color);
}

std::vector<Solid> readRoom(SceneTable& table) {
  Vector3d low, high;
  const std::array<std::string, 3> keys = {"x_m", "y_m", "z_m"};
  for (int axis = 0; axis < 3; ++axis) {
    const std::string& key = keys[static_cast<std::size_t>(axis)];
    const std::vector<double> range = table.numbers(key, 2);
    if (!(range[0] < range[1]) || range[0] < -500 || range[1] > 500)
      table.fail(key, "'" + key + "' is no range within -500 .. 500 m; give [low, high]");
    low[axis] = range[0];
    high[axis] = range[1];
  }
  const double t = table.number("thickness_m", 0.1);
  if (t < 1e-4 || t > 10)
    table.fail("thickness_m", "'thickness_m' is " + std::to_string(t) + "; allowed: 0.0001 .. 10");
  const Solid::Color color = readColor(table, table.text("color", "#d8d8d8"));
  table.finish();

  const Vector3d wide_low = low - Vector3d(t, t, t), wide_high = high + Vector3d(t, t, t);
  std::vector<Solid> slabs;
  slabs.push_back(slab(wide_low, {wide_high.x(), wide_high.y(), low.z()}, color));
  slabs.push_back(slab({wide_low.x(), wide_low.y(), high.z()}, wide_high, color));
  slabs.push_back(slab({wide_low.x(), wide_low.y(), low.z()}, {low.x(), wide_high.y(), high.z()}, color));
  slabs.push_back(slab({high.x(), wide_low.y(), low.z()}, {wide_high.x(), wide_high.y(), high.z()}, color));
  slabs.push_back(slab({low.x(), wide_low.y(), low.z()}, {high.x(), low.y(), high.z()}, color));
  slabs.push_back(slab({low.x(), high.y(), low.z()}, {high.x(), wide_high.y(), high.z()}, color));
  return slabs;
}

}  // namespace vantage
