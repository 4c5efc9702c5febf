#pragma once

#include <benchmark/benchmark.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/gpu/egl_context.h"
#include "viewer/inspector.h"
#include "viewer/inspector_model.h"
#include "viewer/offscreen_ui.h"

namespace vantage::benchmarks {

/// A run of the embedded scene `tabletop`, recorded by the program with assignments `key=value` the first
/// time that it is asked for; removed at the end of the process.
std::filesystem::path recordedTabletop(const std::vector<std::string>& assignments);

/// Ten steps as configured.
std::filesystem::path tenSteps();

/// The inspector of 1280 x 800 pixels without a display, and time as it passes before it.
struct InspectorWindow {
  EglContext context;
  Inspector inspector;
  OffscreenUi ui;

  explicit InspectorWindow(Preferences preferences = {});

  InspectorModel& model() { return inspector.model(); }
  /// Opens a file and waits until everything that follows from it is done.
  void open(const std::filesystem::path& file);
  /// Draws frames as the window's loop does until it is so. \throws std::runtime_error if that takes minutes
  void until(const std::function<bool()>& done);
  /// A picture of the step that is asked for was drawn. \param before pictures until it was asked for
  bool hasNewPicture(std::uint64_t before);
  /// Until the step that is asked for has a picture.
  void untilPicture();

  /// Puts driver and key figures of what is shown beside the times.
  void describe(benchmark::State& state);
};

/// Bytes of physical memory that the process held at most since the last forgetPeakMemory().
double peakMemory();
void forgetPeakMemory();
/// Seconds of processor time of all threads so far.
double cpuSeconds();

}  // namespace vantage::benchmarks
