#include "io/robot_file.h"

#include <algorithm>
#include <filesystem>

#include "io/embedded_assets.h"
#include "io/mesh_file.h"
#include "io/suggest.h"
#include "io/text_file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFolder = "robots/", kEnding = ".urdf";

std::vector<std::string> robotNames() {
  std::vector<std::string> names;
  for (const std::string& asset : embeddedAssetNames(kFolder))
    names.push_back(asset.substr(kFolder.size(), asset.size() - kFolder.size() - kEnding.size()));
  return names;
}

std::string assetOf(const std::string& name) {
  return std::string(kFolder) + name + std::string(kEnding);
}

/// The package that a mesh names is a folder above the description.
fs::path inPackage(const std::string& rest, const fs::path& urdf) {
  const std::size_t slash = rest.find('/');
  const std::string package = rest.substr(0, slash);
  for (fs::path folder = fs::absolute(urdf).parent_path(); folder.has_relative_path();
       folder = folder.parent_path())
    if (folder.filename() == package)
      return folder / (slash == std::string::npos ? "" : rest.substr(slash + 1));
  throw InputError(urdf.string(),
                   "names package '" + package + "', and no folder above the file has that name");
}

fs::path meshPath(const std::string& file, const fs::path& urdf) {
  constexpr std::string_view kPackage = "package://", kFile = "file://";
  if (file.starts_with(kPackage)) return inPackage(file.substr(kPackage.size()), urdf);
  if (file.starts_with(kFile)) return file.substr(kFile.size());
  return urdf.parent_path() / file;
}

Box boundsOf(const TriangleMesh& mesh) {
  Box box;
  for (const auto& vertex : mesh.vertices) box.extend(vertex.template cast<double>());
  return box;
}

RobotModel parsed(const std::string& text, const std::string& source, const std::string& camera_link,
                  const MeshBounds& meshes) {
  try {
    return parseUrdf(text, camera_link, meshes);
  } catch (const RobotModelError& error) {
    throw InputError(source, error.what());
  }
}

/// First line of the first comment.
std::string descriptionIn(std::string_view urdf) {
  const std::size_t begin = urdf.find("<!-- ");
  if (begin == std::string_view::npos) return {};
  return std::string(urdf.substr(begin + 5, urdf.find_first_of("\n", begin) - begin - 5));
}

}  // namespace

RobotModel loadRobot(const std::string& name_or_path, const std::string& camera_link) {
  const std::vector<std::string> names = robotNames();
  if (std::find(names.begin(), names.end(), name_or_path) != names.end())
    return parsed(std::string(embeddedAsset(assetOf(name_or_path))), name_or_path, camera_link, {});
  std::error_code ignored;
  if (!fs::exists(name_or_path, ignored) && fs::path(name_or_path).extension() != kEnding)
    throw InputError(name_or_path, "is neither the name of an arm (vantage robots) nor a URDF file" +
                                       suggestion(name_or_path, names));
  const auto meshes = [&](const std::string& file) {
    return boundsOf(loadMesh(meshPath(file, name_or_path).string()));
  };
  return parsed(readTextFile(name_or_path), name_or_path, camera_link, meshes);
}

std::vector<EmbeddedRobot> embeddedRobots() {
  std::vector<EmbeddedRobot> robots;
  for (const std::string& name : robotNames())
    robots.push_back({name, descriptionIn(embeddedAsset(assetOf(name)))});
  return robots;
}

}  // namespace vantage
