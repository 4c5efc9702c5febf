// Recipes as TOML files.
#include <toml++/toml.h>

#include <cstdlib>
#include <utility>

#include "io/error.h"
#include "io/scene_table.h"
#include "io/suggest.h"
#include "snapshots/recipe.h"
#include "viewer/captions.h"
#include "viewer/view_toml.h"

namespace vantage {
namespace {

constexpr std::pair<const char*, Figures*> kCaptions[] = {
    {"scan", scanFigures},        {"filters", filterFigures}, {"states", stateFigures},
    {"contours", contourFigures}, {"normals", normalFigures}, {"poses", poseFigures},
    {"segments", segmentFigures}, {"views", viewFigures},     {"octree", octreeFigures},
    {"rays", rayFigures},         {"utility", utilityFigures}};

/// The layers of a recipe, which it must name.
LayerSet layersOf(const toml::table& document, const std::string& source) {
  const toml::node* node = document.get("layers");
  if (!node)
    throw InputError(source, "'layers' is missing; name what is to be shown, e.g. layers = [\"surface\"]");
  const LayerSet layers = readLayers(*node, source);
  if (layers == LayerSet())
    throw InputError(tomlPlace(source, node->source()),
                     "'layers' is no list of names; write layers = [\"surface\"]");
  return layers;
}

Figures* readCaption(SceneTable& table) {
  const std::string wanted = table.text("caption", "states");
  std::vector<std::string> known;
  for (const auto& [name, figures] : kCaptions) {
    if (wanted == name) return figures;
    known.emplace_back(name);
  }
  table.fail("caption", "there is no caption '" + wanted + "'" + suggestion(wanted, known));
}

toml::table parse(const std::filesystem::path& file) {
  constexpr std::uintmax_t kLargestFile = 1u << 20;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw InputError(file.string(), "is no file; give a recipe file or one of the built-in recipes");
  if (std::filesystem::file_size(file, error) > kLargestFile)
    throw InputError(file.string(), "is too large for a recipe; allowed: 1 MiB");
  try {
    return toml::parse_file(file.string());
  } catch (const toml::parse_error& broken) {
    throw InputError(tomlPlace(file.string(), broken.source()),
                     "broken TOML: " + std::string(broken.description()));
  }
}

}  // namespace

Recipe readRecipe(const std::filesystem::path& file) {
  const std::string source = file.string();
  const toml::table document = parse(file);
  Recipe recipe;
  recipe.name = file.stem().string();
  recipe.purpose = "recipe of " + source;
  recipe.view.layers = layersOf(document, source);
  constexpr UnknownKeys kUnknown = UnknownKeys::Refused;
  if (const auto* part = tomlPart(document, "style", source))
    readStyle(*part, source, kUnknown, recipe.view.style);
  if (const auto* part = tomlPart(document, "camera", source))
    readCamera(*part, source, kUnknown, recipe.view.camera);
  if (const auto* part = tomlPart(document, "looks", source)) readLooks(*part, source, kUnknown, recipe.view);
  if (const auto* part = tomlPart(document, "clip", source))
    recipe.view.clip = readBox(*part, source, kUnknown);

  SceneTable top(document, source, "recipe");
  recipe.title = top.text("title", recipe.name);
  recipe.figures = readCaption(top);
  top.accept({"layers", "style", "camera", "looks", "clip"});
  top.finish();
  return recipe;
}

void setStyle(LayerStyle& style, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string source = "style '" + assignment + "'";
  if (equals == 0 || equals == std::string::npos || equals + 1 == assignment.size())
    throw InputError(source, "is no assignment; write KEY=VALUE, e.g. octree_level=2");
  const std::string key = assignment.substr(0, equals), value = assignment.substr(equals + 1);
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  toml::table table;
  if (*end == '\0')
    table.insert(key, number);
  else
    table.insert(key, value);
  readStyle(table, source, UnknownKeys::Refused, style);
}

Recipe recipeFrom(const std::string& name_or_file) {
  const std::filesystem::path path(name_or_file);
  if (path.extension() == ".toml" || path.has_parent_path()) return readRecipe(path);
  return recipeNamed(name_or_file);
}

}  // namespace vantage
