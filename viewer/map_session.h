#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/table_file.h"
#include "viewer/step_data.h"

namespace vantage {

/// Shows a file that is no run like one step: a TSDF or an octree by its states, a scene or a mesh as the
/// true scene, a cloud as the surface, a table of views as candidates. The workspace is what the file covers.
/// Whatever no map tells is unknown. \param file also the name of a built-in scene. \param warnings what was
/// put right in the file is added; may be null. \throws InputError: missing, damaged, or of a kind that
/// cannot be shown alone (run, recipe, configuration, data set); std::runtime_error if it does not fit in
/// memory.
StepData openAsStep(const std::filesystem::path& file, std::vector<std::string>* warnings = nullptr);

/// The step with these views as its candidates instead of its own; no view is chosen or scored. \pre
/// !step.empty()
StepData withViews(StepData step, const std::vector<ViewRow>& views);

}  // namespace vantage
