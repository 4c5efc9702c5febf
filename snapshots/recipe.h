#pragma once

#include <string>
#include <vector>

#include "viewer/scene.h"

namespace vantage {

/// A named kind of picture of a step.
struct Recipe {
  std::string name;     ///< on the command line and in file names
  std::string title;    ///< above the picture
  std::string purpose;  ///< one line for help texts
  ViewSettings view;
  std::string (*figures)(const SceneFrame& frame) = nullptr;  ///< the sentence under the title
  bool planning = true;  ///< shows products of planning, which the map after the last scan does not have
};

/// All recipes, in the order of a contact sheet's columns.
const std::vector<Recipe>& recipes();

/// Names of all recipes.
std::vector<std::string> recipeNames();

/// Names of those that are made unless others are asked for.
std::vector<std::string> defaultRecipes();

/// \throws InputError that suggests the nearest known name.
const Recipe& recipeNamed(const std::string& name);

/// The recipe's view for a frame: without ground truth the fused surface stands in for the true scene.
ViewSettings viewFor(const Recipe& recipe, const SceneFrame& frame);

}  // namespace vantage
