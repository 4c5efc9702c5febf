#pragma once

#include <toml++/toml.h>

#include <string>

#include "io/scene_table.h"
#include "viewer/eye.h"
#include "viewer/view_settings.h"

namespace vantage {

// How layers, styles and eyes are written in TOML: recipes, preferences of the window. Readers take over the
// keys that are there and leave the rest as it was; they do not refuse keys that they do not know,
// SceneTable::finish() does. They throw InputError naming the line: a wrong type, an unknown word (with the
// nearest known one), a value out of range. What writers give, readers read back to equal values.

/// List of layer names. \param node of the document `source`
LayerSet readLayers(const toml::node& node, const std::string& source);
toml::array layersToToml(const LayerSet& layers);

void readStyle(SceneTable& table, LayerStyle& style);
toml::table styleToToml(const LayerStyle& style);

void readCamera(SceneTable& table, CameraView& camera);
toml::table cameraToToml(const CameraView& camera);

/// Tables by layer name with `opacity`, `size`, `color_map`.
void readLooks(const toml::table& looks, const std::string& source, ViewSettings& view);
/// Those that differ from the default.
toml::table looksToToml(const ViewSettings& view);

/// `min_m`, `max_m`: three numbers each.
Box readBox(SceneTable& table);
toml::table boxToToml(const Box& box);

/// `position_m`, `focus_m`, `up`, `fov_deg`.
Eye readEye(SceneTable& table);
toml::table eyeToToml(const Eye& eye);

/// A table of the document, or nothing if it is not there. \throws InputError if it is no table.
const toml::table* tomlPart(const toml::table& document, const char* name, const std::string& source);

}  // namespace vantage
