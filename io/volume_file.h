#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/volume/tsdf_volume.h"
#include "io/error.h"

namespace vantage {

/// Reads a TSDF from VTK XML image data (`.vti`, ASCII or appended, raw or compressed): arrays `tsdf` (in
/// [-1, 1], positive = empty) and `weight` (0 = unknown) as point data, or as cell data, whose voxel centres
/// lie half a spacing from the file's origin. Weights are rounded, but stay above 0 if they were. What was
/// put right is added to `warnings`: NaN makes a voxel unknown, values beyond [-1, 1] are cut off. \throws
/// InputError naming the file: missing, not image data, damaged, an array missing or of another size,
///         spacing not cubic, turned axes, or more voxels than the file can hold.
TsdfVolume readVolume(const std::filesystem::path& path, std::vector<std::string>& warnings);

/// Writes point data arrays `tsdf` (float32) and `weight` (uint16), appended and zlib-compressed;
/// readVolume() gives back an equal volume.
/// \throws InputError if the file cannot be created, std::runtime_error if it cannot be written in full,
/// std::invalid_argument for an empty volume.
void writeVolume(const std::filesystem::path& path, const TsdfVolume& volume);

}  // namespace vantage
