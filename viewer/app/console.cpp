#include "viewer/app/console.h"

#include <fmt/format.h>
#include <pthread.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <ctime>
#include <nlohmann/json.hpp>
#include <thread>

namespace vantage::app {
namespace {

using Clock = std::chrono::steady_clock;

bool g_log_json = false;  // set once by setUpLog(), before any work starts

/// SIGINT and SIGTERM as a set.
sigset_t stopSignals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

}  // namespace

void setUpLog(const GlobalOptions& global) {
  auto logger =
      std::make_shared<spdlog::logger>("vantage", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern(global.log_json ? "%v" : "[%H:%M:%S.%e] %v");
  logger->set_level(global.verbose ? spdlog::level::debug : spdlog::level::off);
  spdlog::set_default_logger(logger);
  g_log_json = global.log_json;
}

void say(const GlobalOptions& global, const std::string& line) {
  if (global.quiet) return;
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
  std::atomic<bool> interrupted{false};
  sigset_t previous_mask{};
  std::jthread signal_thread;

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
  // Signals are taken by one thread of our own, so a stop can be requested with ordinary code.
  const sigset_t set = stopSignals();
  pthread_sigmask(SIG_BLOCK, &set, &state_->previous_mask);
  state_->signal_thread = std::jthread([state = state_.get()](const std::stop_token& ended) {
    const sigset_t signals = stopSignals();
    const timespec poll{0, 50'000'000};
    while (!ended.stop_requested())
      if (sigtimedwait(&signals, nullptr, &poll) > 0) {
        if (state->interrupted.exchange(true)) _exit(130);  // asked twice: leave at once
        state->stop.request_stop();
      }
  });
}

Console::~Console() {
  clear();
  state_->signal_thread.request_stop();
  state_->signal_thread.join();
  pthread_sigmask(SIG_SETMASK, &state_->previous_mask, nullptr);
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
  return state_->interrupted;
}

}  // namespace vantage::app
