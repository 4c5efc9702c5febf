#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "viewer/image.h"
#include "viewer/scene_frame.h"

namespace vantage {

class InspectorModel;

/// Makes a picture of a step. `what_if`: parameters that differ from the run, for the caption; empty if none
/// do.
using PictureOf = std::function<RgbImage(const SceneFrame&, const std::string& what_if)>;

// What the window writes into files. The model tells what was written, or why nothing was.

/// The step that is shown, as RUN-stepN-view.png in the current folder; a file that is there gets a number.
void savePicture(InspectorModel& model, const PictureOf& picture);
/// The parameters that are tried, as a configuration file.
void saveConfig(InspectorModel& model, const std::filesystem::path& file);

}  // namespace vantage
