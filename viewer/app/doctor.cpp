#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "core/gpu/egl_context.h"
#include "viewer/app/command.h"
#include "viewer/app/json_output.h"

namespace vantage::app {
namespace {

/// Instruction sets that the vector code can choose from here.
std::string vectorUnit() {
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw")) return "AVX-512";
  if (__builtin_cpu_supports("avx2")) return "AVX2";
  return "plain";
}

int doctor(const GlobalOptions& global) {
  nlohmann::ordered_json report;
  fmt::print("{}", versionText(false));
  fmt::print("compute  cpu: {} threads, {} instructions\n", std::thread::hardware_concurrency(),
             vectorUnit());
  report["compute"] = {{"cpu", {{"threads", std::thread::hardware_concurrency()}, {"vector", vectorUnit()}}}};
  int code = 0;
  try {
    EglContext context;
    for (const GlAttempt& attempt : context.attempts())
      fmt::print("render   {}: {}\n", attempt.platform, attempt.reason.empty() ? "works" : attempt.reason);
    fmt::print("render   {}\n", context.describe());
    report["render"] = {{"works", true}, {"description", context.describe()}};
  } catch (const GlUnavailable& e) {
    for (const GlAttempt& attempt : e.failure().attempts)
      fmt::print("render   {}: {}\n", attempt.platform, attempt.reason);
    fmt::print("render   no picture can be made: {}\n", adviseOnGl(e.failure()));
    report["render"] = {{"works", false}, {"advice", adviseOnGl(e.failure())}};
    code = 3;
  }
  writeJson(global.json, report);
  return code;
}

}  // namespace

void addDoctor(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command =
      app.add_subcommand("doctor", "Try every rendering and compute back end and say what is missing");
  command->footer("Example: vantage doctor");
  command->callback([&global, &action] { action = [&global] { return doctor(global); }; });
}

}  // namespace vantage::app
