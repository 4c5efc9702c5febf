#include "viewer/inspector_output.h"

#include <exception>

#include "io/text_file.h"
#include "viewer/inspector_model.h"

namespace vantage {
namespace {

/// A name that no file has: STEM.png, STEM-2.png, ...
std::filesystem::path freeName(const std::string& stem) {
  std::filesystem::path file = stem + ".png";
  for (int n = 2; std::filesystem::exists(file); ++n) file = stem + "-" + std::to_string(n) + ".png";
  return file;
}

/// Runs `save`, which returns what it did.
template <class Save>
void tell(InspectorModel& model, Save save) {
  try {
    model.say(Notice::Level::Info, save());
  } catch (const std::exception& e) {
    model.say(Notice::Level::Error, e.what());
  }
}

}  // namespace

void savePicture(InspectorModel& model, const PictureOf& picture) {
  const StepData& shown = model.shown();
  if (shown.empty()) return;
  tell(model, [&] {
    const std::string step = std::to_string(shown.record->step);
    const std::filesystem::path file = freeName(model.file().stem().string() + "-step" + step + "-view");
    writePng(picture(shown.frame(), model.whatIf().edits().summary()), file);
    return "picture saved as " + std::filesystem::absolute(file).string();
  });
}

void saveConfig(InspectorModel& model, const std::filesystem::path& file) {
  tell(model, [&] {
    saveFile(file, model.whatIf().edits().toml());
    return "parameters written to " + file.string();
  });
}

}  // namespace vantage
