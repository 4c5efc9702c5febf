#include "viewer/app/console.h"

#include <fmt/format.h>
#include <pthread.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

namespace vantage::app {
namespace {

using Clock = std::chrono::steady_clock;

bool g_log_json = false;  // set once by setUpLog(), before any work starts

/// Ends the program at once, as a shell expects of one that was interrupted.
constexpr int kInterruptedCode = 130;
constexpr std::chrono::seconds kOneRequest{
    1};  // signals so close together are one: an arm has to be stopped first

/// SIGINT, SIGTERM and SIGHUP as a set.
sigset_t stopSignals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGHUP);
  return set;
}

/// Who is asked to stop by a signal: the console that exists now, if any.
struct StopTarget {
  std::mutex mutex;
  std::stop_source* stop = nullptr;
};
StopTarget& stopTarget() {
  static StopTarget target;
  return target;
}

}  // namespace

void watchStopSignals() {
  const sigset_t set = stopSignals();
  std::signal(SIGXFSZ, SIG_IGN);              // a file that grows too large is a failed write, not a death
  pthread_sigmask(SIG_BLOCK, &set, nullptr);  // threads made later inherit this
  stopTarget();
  std::thread([set] {
    Clock::time_point asked_at;
    for (int signal = 0; sigwait(&set, &signal) == 0;) {
      const std::lock_guard lock(stopTarget().mutex);
      std::stop_source* stop = stopTarget().stop;
      if (stop && stop->request_stop()) {
        asked_at = Clock::now();
        continue;
      }
      if (stop && Clock::now() - asked_at < kOneRequest) continue;
      std::fputs("vantage: interrupted; nothing more was written\n", stderr);
      _exit(kInterruptedCode);  // nothing to save, or asked twice
    }
  }).detach();
}

void setUpLog(const GlobalOptions& global) {
  auto logger =
      std::make_shared<spdlog::logger>("vantage", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern(global.log_json ? "%v" : "[%H:%M:%S.%e] %v");
  logger->set_level(global.verbose ? spdlog::level::debug : spdlog::level::off);
  spdlog::set_default_logger(logger);
  g_log_json = global.log_json;
}

void say(const GlobalOptions& global, const std::string& line) {
  if (global.quiet || global.json == "-") return;  // "-": standard output belongs to the JSON
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

void warn(const std::string& message) {
  std::fprintf(stderr, "vantage: warning: %s\n", message.c_str());
}

void logDetail(const std::string& line) {
  if (!g_log_json) {
    spdlog::debug(line);
    return;
  }
  const double now_s =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  spdlog::debug(nlohmann::json{{"time_s", now_s}, {"level", "debug"}, {"message", line}}.dump());
}

struct Console::State {
  bool bar = false;  // draw on a terminal
  bool drawn = false;
  std::string phase;
  Clock::time_point phase_start, last_draw;
  std::stop_source stop;

  void draw(std::string_view name, std::uint64_t done, std::uint64_t total) {
    const auto now = Clock::now();
    if (name != phase) {
      phase = name;
      phase_start = now;
    } else if (now - last_draw < std::chrono::milliseconds(100)) {
      return;
    }
    last_draw = now;
    const double elapsed_s = std::chrono::duration<double>(now - phase_start).count();
    const double rate = elapsed_s > 0 ? static_cast<double>(done) / elapsed_s : 0.0;
    std::string line = fmt::format("{:<12}", name);
    if (total > 0) {
      constexpr int kWidth = 30;
      const int filled = static_cast<int>(kWidth * std::min(done, total) / total);
      line += fmt::format(" [{:#<{}}{:<{}}] {}/{}", "", filled, "", kWidth - filled, done, total);
      if (rate > 0)
        line += fmt::format("  {:.3g}/s, {:.0f} s left", rate,
                            static_cast<double>(total - std::min(done, total)) / rate);
    } else {
      line += fmt::format(" {}", done);
    }
    std::fprintf(stderr, "\r\x1b[2K%s", line.c_str());
    std::fflush(stderr);
    drawn = true;
  }
};

Console::Console(const GlobalOptions& global) : state_(std::make_unique<State>()) {
  state_->bar = !global.quiet && !global.verbose && isatty(STDERR_FILENO);
  const std::lock_guard lock(stopTarget().mutex);
  stopTarget().stop = &state_->stop;
}

Console::~Console() {
  clear();
  const std::lock_guard lock(stopTarget().mutex);
  stopTarget().stop = nullptr;
}

RunControl Console::control() {
  RunControl control;
  control.stop = state_->stop.get_token();
  if (state_->bar)
    control.progress = [state = state_.get()](std::string_view phase, std::uint64_t done,
                                              std::uint64_t total) { state->draw(phase, done, total); };
  return control;
}

void Console::clear() {
  if (!state_->drawn) return;
  std::fprintf(stderr, "\r\x1b[2K");
  std::fflush(stderr);
  state_->drawn = false;
}

bool Console::interrupted() const {
  return state_->stop.stop_requested();
}

}  // namespace vantage::app
