#include <fmt/format.h>

#include "core/gpu/egl_context.h"
#include "viewer/app/command.h"

namespace vantage::app {

std::string versionText(bool verbose) {
  std::string text = fmt::format("vantage {} ({})\n", VANTAGE_VERSION, VANTAGE_COMMIT);
  text += fmt::format("VTK {}, PCL {}, OctoMap {}\n", VANTAGE_VTK, VANTAGE_PCL, VANTAGE_OCTOMAP);
  if (!verbose) return text;
  try {
    text += EglContext().describe() + "\n";
  } catch (const GlUnavailable& e) {
    text += std::string("OpenGL: ") + e.what() + "\n";
  }
  return text;
}

}  // namespace vantage::app
