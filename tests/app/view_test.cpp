// `vantage view`: the task it was made for, done by a scripted user; and the real window.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/program.h"
#include "tests/support/process.h"
#include "tests/support/recorded_run.h"
#include "tests/viewer/inspector_driver.h"

namespace vantage {
namespace {

using test::ProcessOptions;
using test::ProcessResult;
using test::runProcess;
using test::TemporaryFolder;
using ::testing::HasSubstr;
using testing::InspectorDriver;

const std::string kB = "saliency.isolation_distance_m";

/// Without a display, whatever the test has.
ProcessResult runVantage(std::vector<std::string> words, const TemporaryFolder& folder) {
  const std::vector<std::string> start = {"/usr/bin/env",    "-u",          "DISPLAY", "-u",
                                          "WAYLAND_DISPLAY", VANTAGE_BINARY};
  words.insert(words.begin(), start.begin(), start.end());
  ProcessOptions options;
  options.folder = folder.path();
  options.environment = {{"XDG_STATE_HOME", folder / "state"}, {"XDG_CONFIG_HOME", folder / "config"}};
  return runProcess(words, options);
}

/// The segment that is tried first is the ball, which is about the scene's middle.
bool ballComesFirst(const StepRecord& record) {
  if (!record.search || record.search->segments.empty() || record.search->segments.front().segment < 0)
    return false;
  const Segment& first = record.saliency->segments[record.search->segments.front().segment];
  return first.center_m.head<2>().norm() < 0.06 && first.radius_m < 0.08;
}

TEST(View, AScriptedUserFindsTheIsolationDistanceThatKeepsTheSmallBallSalient) {
  const TemporaryFolder folder;
  const std::string scene = testing::ballScene().string();
  ProcessResult explored = runVantage({"explore", scene, "--steps", "1", "-o", "ball.vantage"}, folder);
  ASSERT_EQ(explored.code, 0) << explored.err;

  InspectorDriver driver;
  driver.open(folder / "ball.vantage");
  ASSERT_FALSE(ballComesFirst(*driver.model().shown().record));
  driver.ui.click("tab/What if");
  // Pulls the slider to the left, a bit more each time, until the ball's number is 1 in the picture.
  double from = 0.75;
  for (double to = 0.65; to > 0.1 && !ballComesFirst(*driver.model().shown().record); to -= 0.05) {
    driver.ui.drag("what-if/" + kB, from, 0.5, to, 0.5);
    from = to;
  }
  driver.ui.settle();
  ASSERT_TRUE(ballComesFirst(*driver.model().shown().record));
  ASSERT_EQ(driver.whatIf().state(), WhatIfState::Settled);
  ASSERT_TRUE(driver.model().shown().record->hasView());
  const ChosenView first = *driver.model().shown().record->chosen();
  EXPECT_NE(first.id, driver.model().recorded().record->chosen()->id);

  driver.ui.click("what-if/copy");
  EXPECT_NE(driver.clipboard.find("isolation_distance_m = "), std::string::npos) << driver.clipboard;
  driver.ui.click("what-if/write config…");
  driver.ui.frame();
  driver.ui.enter("file/name", folder / "found.toml");
  driver.ui.settle();
  ASSERT_EQ(test::readFile(folder / "found.toml"), driver.clipboard);

  explored = runVantage({"explore", scene, "--config", "found.toml", "--steps", "1", "-o", "again.vantage",
                         "--json", "again.json"},
                        folder);
  ASSERT_EQ(explored.code, 0) << explored.err;
  const auto step = nlohmann::json::parse(test::readFile(folder / "again.json")).at("steps").at(0);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(step.at("position_m").at(i), first.T_world_camera.translation()[i], 1e-9);
  const Eigen::Quaterniond q(first.T_world_camera.linear());
  double dot = 0.0;
  for (int i = 0; i < 4; ++i) dot += step.at("quaternion_xyzw").at(i).get<double>() * q.coeffs()[i];
  EXPECT_NEAR(std::abs(dot), 1.0, 1e-9);
  EXPECT_DOUBLE_EQ(step.at("gain"), first.gain);
}

TEST(View, DrawsTheWindowIntoAFileWithoutADisplay) {
  const TemporaryFolder folder;
  testing::recordRun(testing::ballScene(), {"exploration.steps=1"}, folder / "run.vantage");
  const ProcessResult drawn =
      runVantage({"view", "run.vantage", "--picture", "window.png", "--size", "800x600"}, folder);
  EXPECT_EQ(drawn.code, 0) << drawn.err;
  EXPECT_GT(std::filesystem::file_size(folder / "window.png"), 20000u);
}

TEST(View, FilesThatCannotBeShownAreOneLine) {
  const TemporaryFolder folder;
  const ProcessResult missing = runVantage({"view", "missing.vantage"}, folder);
  EXPECT_EQ(missing.code, 2);
  EXPECT_NE(missing.err.find("missing.vantage"), std::string::npos) << missing.err;
  test::writeFile(folder / "broken.vantage", "no run");
  const ProcessResult broken = runVantage({"view", "broken.vantage", "--picture", "x.png"}, folder);
  EXPECT_NE(broken.code, 0);
  EXPECT_EQ(std::ranges::count(broken.err, '\n'), 1) << broken.err;
}

TEST(View, WithoutADisplayItSaysWhatHelps) {
  const TemporaryFolder folder;
  ProcessOptions options;
  options.folder = folder.path();
  options.environment = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}};
  const ProcessResult result = runProcess({VANTAGE_BINARY, "view"}, options);
  EXPECT_EQ(result.code, 3) << result.err;
  EXPECT_NE(result.err.find("vantage snapshot"), std::string::npos) << result.err;
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
}

/// Colours on the screen of an X server that keeps its memory in a file (XWD format, 32 bits a pixel).
std::size_t colorsOnScreen(const std::string& file) {
  const std::string bytes = test::readFile(file);
  const auto word = [&](std::size_t i) {
    std::uint32_t value = 0;
    for (int b = 0; b < 4; ++b) value = value << 8 | static_cast<std::uint8_t>(bytes.at(4 * i + b));
    return value;
  };
  const std::size_t pixels = word(0) + 12 * static_cast<std::size_t>(word(19));
  std::set<std::uint32_t> colors;
  for (std::size_t at = pixels; at + 4 <= bytes.size(); at += 4) {
    std::uint32_t color = 0;
    for (int b = 0; b < 3; ++b) color = color << 8 | static_cast<std::uint8_t>(bytes[at + b]);
    colors.insert(color);
  }
  return colors.size();
}

/// Runs a script in a folder with an X server of its own, whose screen is kept in the file `screen` until the
/// last line; `$window` is the inspector's process.
ProcessResult underXvfb(const TemporaryFolder& folder, const std::string& before,
                        const std::string& arguments, const std::string& after) {
  const std::string script = R"(
Xvfb -displayfd 3 -screen 0 1280x800x24 -fbdir . -nolisten tcp -noreset 3>display 2>/dev/null & server=$!
trap 'kill $server' EXIT
for i in $(seq 100); do [ -s display ] && break; sleep 0.1; done
export DISPLAY=:$(cat display) XDG_STATE_HOME=$PWD/state
)" + before + "\n" VANTAGE_BINARY " view " +
                             arguments + " & window=$!\n" + after + "\n";
  ProcessOptions options;
  options.folder = folder.path();
  return runProcess({"/bin/bash", "-c", script}, options);
}

std::string remembered(const TemporaryFolder& folder) {
  const std::string file = folder / "state/vantage/inspector.toml";
  return std::filesystem::exists(file) ? test::readFile(file) : "";
}

TEST(View, ADisplayWithoutOpenGl32IsOneLine) {
  const TemporaryFolder folder;
  const ProcessResult result = underXvfb(folder, "export MESA_GL_VERSION_OVERRIDE=2.1", "", "wait $window");
  EXPECT_EQ(result.code, 3) << result.err;
  EXPECT_THAT(result.err, HasSubstr("OpenGL 3.2"));
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
}

TEST(View, OpensARealWindowAndRemembersIt) {
  const TemporaryFolder folder;
  testing::recordRun(testing::ballScene(), {"exploration.steps=1"}, folder / "run.vantage");
  const ProcessResult result = underXvfb(folder, "", "run.vantage --seconds 20", R"(
for i in $(seq 60); do sleep 0.25; cp Xvfb_screen0 screen; done
wait $window)");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_GT(colorsOnScreen(folder / "screen"), 300u) << "the window shows no scene";
  EXPECT_THAT(remembered(folder), HasSubstr("run.vantage"));
}

TEST(View, ARealWindowTakesADroppedFileSavesAPictureAndClosesAtASignal) {
  const TemporaryFolder folder;
  testing::recordRun(testing::ballScene(), {"exploration.steps=1"}, folder / "dropped.vantage");
  const ProcessResult result = underXvfb(folder, X_CLIENT " dpi 192", "", R"(
for i in $(seq 100); do )" X_CLIENT R"( drop dropped.vantage 2>drop.log && break; sleep 0.2; done
for i in $(seq 40); do sleep 0.25; cp Xvfb_screen0 screen; done
)" X_CLIENT R"( ctrl s
for i in $(seq 100); do [ -s dropped-step1-view.png ] && break; sleep 0.2; done
kill -TERM $window
wait $window)");
  EXPECT_EQ(result.code, 0) << result.err << test::readFile(folder / "drop.log");
  EXPECT_GT(colorsOnScreen(folder / "screen"), 300u) << "the window shows no scene";
  EXPECT_THAT(remembered(folder), HasSubstr("dropped.vantage"));
  ASSERT_TRUE(std::filesystem::exists(folder / "dropped-step1-view.png"));
  EXPECT_GT(std::filesystem::file_size(folder / "dropped-step1-view.png"), 20000u)
      << "a picture with its legend";
  // The monitor has half as many points as pixels: the next window is not larger than this one was.
  EXPECT_THAT(remembered(folder), HasSubstr("width = 640"));
}

// Ctrl+Q quits: on a French keyboard Q is where an American one has A.
TEST(View, KeysGoByWhatIsWrittenOnThem) {
  const TemporaryFolder folder;
  const ProcessResult result = underXvfb(folder, "setxkbmap fr", "--seconds 60", R"(
for i in $(seq 100); do )" X_CLIENT R"( ctrl a 2>/dev/null && break; sleep 0.2; done
sleep 1; kill -0 $window && echo "still open"
)" X_CLIENT R"( ctrl q
for i in $(seq 50); do kill -0 $window 2>/dev/null || break; sleep 0.2; done
kill -0 $window 2>/dev/null && kill -KILL $window
wait $window)");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("still open"));
}

}  // namespace
}  // namespace vantage
