#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/program.h"

namespace vantage::test {
namespace {

const std::vector<std::string> kCommands = {"explore", "snapshot", "fuse",      "contours", "views",
                                            "segment", "gain",     "plan",      "scenes",   "config",
                                            "info",    "doctor",   "reproduce", "robots"};

TEST(Usage, AloneItPrintsTheHelpAndExitsWith2) {
  const ProcessResult result = vantage({});
  EXPECT_EQ(result.code, 2);
  EXPECT_TRUE(result.err.empty());
  for (const std::string& command : kCommands)
    EXPECT_NE(result.out.find(command), std::string::npos) << command;
}

TEST(Usage, EveryCommandHasHelpWithAnExample) {
  for (const std::string& command : kCommands) {
    const ProcessResult result = vantage({command, "--help"});
    EXPECT_EQ(result.code, 0) << command;
    EXPECT_NE(result.out.find("Example: vantage " + command), std::string::npos) << result.out;
  }
}

TEST(Usage, VersionNamesTheLibraries) {
  const ProcessResult result = vantage({"--version"});
  EXPECT_EQ(result.code, 0);
  for (const char* part : {"vantage 0.", "VTK 9.", "PCL 1.", "OctoMap 1."})
    EXPECT_NE(result.out.find(part), std::string::npos) << result.out;
}

TEST(Usage, UnknownCommandsSuggestTheNearest) {
  expectRefused(vantage({"explor", "tabletop"}), {"unknown command 'explor'", "did you mean 'explore'?"});
}

TEST(Usage, UnknownOptionsSuggestTheNearest) {
  expectRefused(vantage({"explore", "tabletop", "--snapshot", "x"}),
                {"'--snapshot'", "did you mean '--snapshots'?"});
  expectRefused(vantage({"scenes", "--quite"}), {"'--quite'", "did you mean '--quiet'?"});
}

TEST(Usage, CommandsThatDoNotExistYetAreUnknown) {
  for (const char* command : {"report", "film"}) EXPECT_EQ(vantage({command}).code, 2) << command;
}

TEST(Usage, UnknownKeysSuggestTheNearest) {
  expectRefused(vantage({"config", "--set", "saliency.isolation_dist_m=0.01"}),
                {"saliency.isolation_dist_m", "did you mean", "saliency.isolation_distance_m"});
}

TEST(Usage, TheWindowRefusesWhatItWouldIgnore) {
  expectRefused(vantage({"view", "tabletop", "--set", "saliency.isolation_distance_m=0.01"}),
                {"--set", "beside the run"});
  expectRefused(vantage({"view", "tabletop", "--picture", "window.jpg"}), {"window.jpg", ".png"});
}

TEST(Usage, ValuesOutOfRangeNameTheRange) {
  expectRefused(vantage({"config", "--set", "saliency.isolation_distance_m=7"}),
                {"saliency.isolation_distance_m", "7", "allowed"});
  expectRefused(vantage({"config", "--threads", "-3"}), {"--threads"});
}

TEST(Usage, UnknownScenesSuggestTheNearest) {
  expectRefused(vantage({"explore", "tabeltop"}), {"tabeltop", "tabletop"});
}

TEST(Usage, ScenesPrintsOneNameFirstOnEachLine) {
  const ProcessResult result = vantage({"scenes"});
  EXPECT_EQ(result.code, 0);
  bool tabletop = false, room = false;
  for (const std::string& line : lines(result.out)) {
    tabletop |= line.rfind("tabletop ", 0) == 0;
    room |= line.rfind("room ", 0) == 0;
  }
  EXPECT_TRUE(tabletop && room) << result.out;
}

TEST(Usage, RobotsPrintsOneNameFirstOnEachLine) {
  const ProcessResult result = vantage({"robots"});
  EXPECT_EQ(result.code, 0);
  std::set<std::string> names;
  for (const std::string& line : lines(result.out)) names.insert(line.substr(0, line.find(' ')));
  EXPECT_EQ(names, (std::set<std::string>{"free", "smart_six", "ur5"}));
}

TEST(Usage, RobotsShowsTheJointsOfOne) {
  const ProcessResult result = vantage({"robots", "smart_six", "--json", "-"});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto robot = nlohmann::json::parse(result.out);
  EXPECT_TRUE(robot["closed_form"]);
  ASSERT_EQ(robot["joints"].size(), 6u);
  EXPECT_NEAR(robot["joints"][2]["lower"], -170.0 * 3.14159265358979 / 180.0, 1e-9);
  EXPECT_EQ(vantage({"robots", "free"}).code, 0);
  expectRefused(vantage({"robots", std::string(300, 'a')}), {"nor a URDF file"});
  expectRefused(vantage({"robots", "ur55"}), {"ur55", "did you mean 'ur5'?"});
  expectRefused(vantage({"robots", "ur5", "--camera-link", "eye"}),
                {"ur5: has no link 'eye'", "camera_optical_frame"});
}

TEST(Usage, TheEffectiveConfigurationReadsBackToItself) {
  const TemporaryFolder folder;
  const ProcessResult first = vantage({"config", "tabletop", "--set", "saliency.isolation_distance_m=0.013"});
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("0.013"), std::string::npos);
  EXPECT_NE(first.out.find("--set"), std::string::npos);
  writeFile(folder / "all.toml", first.out);
  const ProcessResult second = vantage({"config", "--config", folder / "all.toml"});
  ASSERT_EQ(second.code, 0) << second.err;
  const auto values = [](const std::string& text) {
    std::string kept;
    for (const std::string& line : lines(text)) kept += line.substr(0, line.find('#')) + "\n";
    return kept;
  };
  EXPECT_EQ(values(first.out), values(second.out));
}

TEST(Usage, LaterSettingsBeatEarlierOnes) {
  const TemporaryFolder folder;
  writeFile(folder / "a.toml", "[gain]\nthreshold = 111\n");
  const ProcessResult file = vantage({"config", "tabletop", "--config", folder / "a.toml"});
  EXPECT_NE(file.out.find("threshold = 111"), std::string::npos) << file.out;
  const ProcessResult set =
      vantage({"config", "tabletop", "--config", folder / "a.toml", "--set", "gain.threshold=222"});
  EXPECT_NE(set.out.find("threshold = 222"), std::string::npos) << set.out;
}

TEST(Doctor, SaysWhichPackageBringsAMissingDriver) {
  const ProcessResult healthy = vantage({"doctor"});
  EXPECT_EQ(healthy.code, 0) << healthy.out;
  ProcessOptions none;
  none.environment = {{"__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent"}};
  const ProcessResult result = vantage({"doctor"}, none);
  EXPECT_EQ(result.code, 3);
  EXPECT_NE(result.out.find("libegl-mesa0"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace vantage::test
