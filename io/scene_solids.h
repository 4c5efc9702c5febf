#pragma once

#include <string>
#include <vector>

#include "io/scene_table.h"
#include "io/solid.h"

namespace vantage {

// Internal to the scene reader.

/// Gives a [[solid]] table without `object` or `color` those that follow from its number.
void completeSolid(toml::table& solid, std::size_t number);

/// Solid of one [[solid]] table that is complete; mesh files are sought in `folder`. \throws InputError
Solid readSolid(SceneTable& table, const std::string& folder);

/// Six slabs of a [room] table. \throws InputError
std::vector<Solid> readRoom(SceneTable& table);

}  // namespace vantage
