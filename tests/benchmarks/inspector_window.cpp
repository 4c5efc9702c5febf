#include "tests/benchmarks/inspector_window.h"

#include <malloc.h>
#include <sys/resource.h>

#include <chrono>
#include <fstream>
#include <map>
#include <stdexcept>
#include <thread>

#include "tests/support/process.h"
#include "viewer/merged_faces.h"

namespace vantage::benchmarks {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

std::filesystem::path recordedTabletop(const std::vector<std::string>& assignments) {
  static const test::TemporaryFolder folder;
  static std::map<std::vector<std::string>, std::string> recorded;
  const auto known = recorded.find(assignments);
  if (known != recorded.end()) return known->second;
  const std::string file = folder / ("run" + std::to_string(recorded.size()) + ".vantage");
  std::vector<std::string> words = {VANTAGE_BINARY, "explore", "tabletop", "-o", file};
  for (const std::string& assignment : assignments) words.insert(words.end(), {"--set", assignment});
  const test::ProcessResult result = test::runProcess(words);
  if (result.code != 0) throw std::runtime_error("no run was recorded: " + result.err);
  return recorded[assignments] = file;
}

std::filesystem::path tenSteps() {
  return recordedTabletop({"exploration.steps=10"});
}

InspectorWindow::InspectorWindow(Preferences preferences)
    : inspector(context, {}, std::move(preferences)), ui(context, inspector, 1280, 800) {
  ui.frame();
}

void InspectorWindow::open(const std::filesystem::path& file) {
  inspector.open({file});
  ui.settle(300.0);
  if (inspector.error()) throw std::runtime_error(*inspector.error());
}

void InspectorWindow::until(const std::function<bool()>& done) {
  constexpr double kLimit_s = 300.0;
  const auto start = Clock::now();
  auto last = start;
  while (!done()) {
    if (secondsSince(start) > kLimit_s) throw std::runtime_error("the window did not get there");
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // the loop is woken when work is done
    const double elapsed_s = secondsSince(last);
    last = Clock::now();
    if (inspector.update(elapsed_s)) ui.frame(elapsed_s);
  }
}

bool InspectorWindow::hasNewPicture(std::uint64_t before) {
  return !model().recorded().empty() && !model().loading() && inspector.picturesRendered() > before;
}

void InspectorWindow::untilPicture() {
  std::uint64_t before = inspector.picturesRendered();
  until([&] {
    if (model().recorded().empty() || model().loading()) before = inspector.picturesRendered();
    return hasNewPicture(before);
  });
}

void InspectorWindow::describe(benchmark::State& state) {
  const StepData& shown = model().shown();
  const Box box = occupiedBox(shown.frame());
  std::size_t faces = 0;
  for (const auto& [voxels, rule] :
       {std::pair{VoxelState::Occupied, FaceRule::TowardOther}, {VoxelState::Unknown, FaceRule::TowardFree}})
    faces += extractMergedFaces(*shown.states, voxels, rule, box).faces;
  state.counters["faces"] = static_cast<double>(faces);
  state.counters["voxels"] = static_cast<double>(shown.states->geometry().count());
  if (shown.record->search)
    state.counters["scored"] = static_cast<double>(shown.record->search->counts.poses_scored);
  state.SetLabel("1280x800, " + context.describe());
}

double peakMemory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return 1024.0 * std::stod(line.substr(6));
  throw std::runtime_error("the system does not tell the memory of a process");
}

void forgetPeakMemory() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

double cpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace vantage::benchmarks
