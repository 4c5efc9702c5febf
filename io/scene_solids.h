#pragma once

#include <string>
#include <vector>

#include "io/scene_table.h"
#include "io/solid.h"

namespace vantage {

/// Solid of one [[solid]] table. \throws InputError. Internal to the scene reader.
Solid readSolid(SceneTable& table, const std::string& folder, std::size_t number);

/// Six slabs of a [room] table. \throws InputError.
std::vector<Solid> readRoom(SceneTable& table);

}  // namespace vantage
