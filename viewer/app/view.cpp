#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>

#include "core/gpu/egl_context.h"
#include "io/error.h"
#include "snapshots/recipe.h"
#include "snapshots/snapshot.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/picture_size.h"
#include "viewer/captions.h"
#include "viewer/file_kind.h"
#include "viewer/inspector.h"
#include "viewer/inspector_model.h"
#include "viewer/offscreen_ui.h"
#include "viewer/window.h"

namespace vantage::app {
namespace {

struct ViewOptions {
  std::vector<std::string> files;
  std::string picture, size = "1280x800";
  double seconds = 0.0;
};

/// A picture of the view with caption and legend, as snapshots have it.
RgbImage pictureOf(const SceneFrame& frame, const ViewSettings& view, const std::string& what_if,
                   GlContext& context, int width, int height) {
  Scene scene;
  scene.setFrame(frame);
  OffscreenRenderer renderer(context);
  const std::string title = what_if.empty() ? "As seen in the inspector" : "What if " + what_if;
  const Recipe recipe{"inspector", title, "", view, viewFigures};
  return drawRecipe(scene, renderer, recipe, frame, width, height);
}

/// What both windows need from the snapshots.
InspectorPorts commonPorts() {
  InspectorPorts ports;
  ports.picture = pictureOf;
  ports.recipe = [](const std::filesystem::path& file) { return readRecipe(file).view; };
  return ports;
}

/// What is no file that the program knows is refused before a window opens.
std::vector<std::filesystem::path> knownFiles(const std::vector<std::string>& files) {
  for (const std::string& file : files) requireKind(file);
  return {files.begin(), files.end()};
}

/// The window drawn into a file, without a display.
int drawWindow(const GlobalOptions& global, const ViewOptions& options,
               const std::vector<std::filesystem::path>& files) {
  const auto [width, height] = parseSize("--size", options.size);
  EglContext context;
  Inspector inspector(context, commonPorts(), Preferences{});
  OffscreenUi ui(context, inspector, width, height);
  inspector.open(files);
  ui.settle();
  if (const auto error = inspector.error()) throw InputError("view", *error);
  writePng(ui.image(), options.picture);
  say(global, options.picture);
  return 0;
}

int openWindow(const GlobalOptions& global, const ViewOptions& options,
               const std::vector<std::filesystem::path>& files) {
  const std::filesystem::path kept = preferencesPath();
  std::string problem;
  Preferences preferences = loadPreferences(kept, &problem);
  Console console(global);  // a signal closes the window like a click: what was set is kept
  WindowOptions window_options;
  window_options.stop = console.control().stop;
  window_options.width = preferences.window_width;
  window_options.height = preferences.window_height;
  window_options.quit_after_s = options.seconds;
  Window window(window_options);
  InspectorPorts ports = commonPorts();
  ports.copy = [&window](const std::string& text) { window.copy(text); };
  ports.wake = [&window] { window.wake(); };
  Inspector inspector(window.context(), std::move(ports), std::move(preferences));
  if (!problem.empty()) inspector.model().say(Notice::Level::Warning, problem);
  inspector.open(files);
  std::exception_ptr error;  // what was set is kept whatever happens
  try {
    window.show(inspector);
  } catch (...) {
    error = std::current_exception();
  }
  Preferences last = inspector.toKeep();
  last.window_width = window.width();
  last.window_height = window.height();
  if (!error) {
    savePreferences(kept, last);
    return 0;
  }
  try {
    savePreferences(kept, last);
  } catch (const std::exception&) {  // what ended the window is told
  }
  std::rethrow_exception(error);
}

int view(const GlobalOptions& global, const ViewOptions& options) {
  if (!global.assignments.empty())
    throw InputError("--set",
                     "does nothing here: put it into a file and open that beside the run, "
                     "vantage view RUN.vantage FILE.toml");
  std::vector<std::string> named = options.files;
  named.insert(named.end(), global.config_files.begin(), global.config_files.end());
  const auto files = knownFiles(named);
  if (!options.picture.empty() && std::filesystem::path(options.picture).extension() != ".png")
    throw InputError("--picture", "'" + options.picture + "' does not end with .png");
  if (!options.picture.empty()) return drawWindow(global, options, files);
  return openWindow(global, options, files);
}

}  // namespace

void addView(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* command = app.add_subcommand(
      "view", "The inspector: a window that shows a run step by step and tries other parameters on it");
  command
      ->add_option("files", options->files,
                   "Run, map, scene, cloud, recipe or configuration; two of them side by side")
      ->type_name("FILE");
  CLI::Option* picture = command
                             ->add_option("--picture", options->picture,
                                          "Draw the window into a PNG file instead, without a display")
                             ->type_name("FILE.png");
  command->add_option("--size", options->size, "Of that picture, pixels; default: 1280x800")
      ->needs(picture)
      ->type_name("WxH");
  command->add_option("--seconds", options->seconds, "Close the window by itself after this time; 0 = never")
      ->check(CLI::Range(0.0, 1e6))
      ->excludes(picture)
      ->type_name("S");
  command->footer("Example: vantage view tabletop.vantage   (F1 in the window lists all keys)");
  command->callback(
      [&global, &action, options] { action = [&global, options] { return view(global, *options); }; });
}

}  // namespace vantage::app
