#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace vantage {
struct StepRecord;
}

namespace vantage::testing {

/// A scene for tests of the inspector: with an isolation distance of 5 cm, as it is configured, the small
/// ball between two blocks is no object of its own, with 3 cm or less it is the most salient segment.
std::filesystem::path ballScene();

/// Explores a scene (file or built-in name) with assignments `key=value` on top of its configuration, and
/// records it as `vantage explore` does. \param written is called after each step, while the file is open
void recordRun(
    const std::filesystem::path& scene, const std::vector<std::string>& assignments,
    const std::filesystem::path& run,
    const std::function<void(const StepRecord&)>& written = [](const StepRecord&) {});

}  // namespace vantage::testing
