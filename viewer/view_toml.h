#pragma once

#include <toml++/toml.h>

#include <string>

#include "viewer/view_settings.h"

namespace vantage {

// How layers, styles and eyes are written in TOML: recipes, preferences of the window. Readers take over the
// keys that are there and leave the rest as it was. They throw InputError naming the line of `source`: a
// wrong type, an unknown word (with the nearest known one), a value out of range. What writers give, readers
// read back to equal values.

/// Keys that a reader does not know.
enum class UnknownKeys {
  Refused,  ///< InputError with the nearest known one
  Ignored,  ///< a newer program may have written them
};

/// List of layer names.
LayerSet readLayers(const toml::node& node, const std::string& source);
toml::array layersToToml(const LayerSet& layers);

void readStyle(const toml::table& part, const std::string& source, UnknownKeys unknown, LayerStyle& style);
toml::table styleToToml(const LayerStyle& style);

void readCamera(const toml::table& part, const std::string& source, UnknownKeys unknown, CameraView& camera);
/// With the exact eye, if there is one, as a table `eye`.
toml::table cameraToToml(const CameraView& camera);

/// Tables by layer name with `opacity`, `size`, `color_map`.
void readLooks(const toml::table& looks, const std::string& source, UnknownKeys unknown, ViewSettings& view);
/// Those that differ from the default.
toml::table looksToToml(const ViewSettings& view);

/// `min_m`, `max_m`: three numbers each, metres.
Box readBox(const toml::table& part, const std::string& source, UnknownKeys unknown);
toml::table boxToToml(const Box& box);

/// `position_m`, `focus_m`, `up`, `fov_deg`; all are wanted. In a bookmark they stand beside other keys.
Eye readEye(const toml::table& part, const std::string& source, UnknownKeys unknown);
toml::table eyeToToml(const Eye& eye);

/// A table of the document, or nothing if it is not there. \throws InputError if it is no table.
const toml::table* tomlPart(const toml::table& document, const char* name, const std::string& source);

}  // namespace vantage
