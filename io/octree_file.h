#pragma once

#include <filesystem>

#include "core/volume/occupancy_octree.h"
#include "io/error.h"

namespace vantage {

/// Text beside an octree that says which space it maps and where the object is: `MAP.bt.toml` with
/// `map_min_m`, `map_max_m` and, optional, `object_min_m`, `object_max_m`: three numbers each, metres.
std::filesystem::path octreeBoxPath(const std::filesystem::path& map);

/// Reads an OctoMap file, `.bt` or `.ot`; what it is says its first line. The grid covers the stored voxels,
/// at least one more on each side (space that is not stored is unknown), and the boxes in the text beside the
/// file, if there is one; without it everything is the object's box.
/// \throws InputError naming the file and what is wrong: missing, no OctoMap file, another tree type, a bad
/// resolution, damaged, too large for the memory; or naming the text and its key.
OccupancyOctree readOctree(const std::filesystem::path& path, const OccupancyConfig& config);

/// Writes `.ot` (probabilities) or `.bt` (labels alone), by the ending, and the text with the boxes beside it.
/// readOctree() gives back equal labels, and from `.ot` equal values.
/// \throws InputError for another ending or if a file cannot be created, std::runtime_error if one cannot be
/// written in full.
void writeOctree(const std::filesystem::path& path, const OccupancyOctree& map);

}  // namespace vantage
