#include "io/config_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <numbers>
#include <set>

#include "io/config_fields.h"

namespace vantage {
namespace {

using testing::HasSubstr;

std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

std::string tomlError(const std::string& text, const std::vector<std::string>& ignored = {}) {
  Settings settings;
  return errorOf([&] { applyToml(settings, text, "a.toml", ignored); });
}

std::string setError(const std::string& text) {
  Settings settings;
  return errorOf([&] { applyAssignment(settings, text); });
}

/// A legal value of the field that differs from its default.
config::Value otherValue(const config::Field& field) {
  const config::Value current = field.get(Settings{});
  switch (field.kind) {
    case config::Kind::Boolean:
      return !std::get<bool>(current);
    case config::Kind::Choice:
      for (const std::string& choice : field.choices)
        if (choice != std::get<std::string>(current)) return choice;
      ADD_FAILURE() << field.key << " has one choice only";
      return current;
    case config::Kind::Names:
      return field.choices.back() + "," + field.choices.front();
    case config::Kind::Integer: {
      const auto value = std::get<std::int64_t>(current);
      return value < static_cast<std::int64_t>(field.high) ? value + 1 : value - 1;
    }
    case config::Kind::Number: {
      const double value = std::get<double>(current);
      const double other = value + 0.1234567 * (value < 1.0 ? 0.1 : 1.0);
      return other <= field.high ? other : value / 3.0;
    }
    case config::Kind::Numbers:
      if (field.max_count == 4) return std::vector<double>{0.6, 0.0, -0.8, 0.0};
      if (field.key == "arm.clear_boxes_m") return std::vector<double>{0.1, 0.2, 1.0 / 3.0, 4.0, 5.5, 6.0};
      if (field.min_count != field.max_count) return std::vector<double>{1.0 / 3.0, 0.7, 2.5};
      return std::vector<double>{1.0 / 3.0, -0.125, 7.3};
    case config::Kind::Integers:
      return std::vector<double>{12, 34, 56};
  }
  return current;
}

TEST(ConfigFields, KeysAreUniqueAndInSections) {
  ASSERT_GT(config::fields().size(), 60u);
  std::set<std::string> keys;
  for (const config::Field& field : config::fields()) {
    EXPECT_TRUE(keys.insert(field.key).second) << field.key;
    EXPECT_EQ(std::count(field.key.begin(), field.key.end(), '.'), 1) << field.key;
    EXPECT_FALSE(field.documentation.empty()) << field.key;
  }
}

TEST(ConfigFields, EveryDefaultIsInItsOwnRange) {
  const Settings defaults;
  for (const config::Field& field : config::fields())
    EXPECT_NO_THROW(config::checked(field, field.get(defaults))) << field.key;
}

TEST(ConfigFields, EveryFieldReachesAPlaceOfItsOwn) {
  for (const config::Field& field : config::fields()) {
    Settings settings;
    field.set(settings, config::checked(field, otherValue(field)));
    for (const config::Field& other : config::fields()) {
      const bool same = other.get(settings) == other.get(Settings{});
      EXPECT_EQ(same, other.key != field.key) << field.key << " set, " << other.key << " looked at";
    }
  }
}

TEST(ConfigFile, WritingAndReadingGivesEqualValuesForEveryField) {
  Settings written;
  for (const config::Field& field : config::fields())
    field.set(written, config::checked(field, otherValue(field)));
  Settings read;
  applyToml(read, effectiveToml(written), "again");
  for (const config::Field& field : config::fields())
    EXPECT_EQ(field.get(read), field.get(written)) << field.key;
  EXPECT_EQ(read.exploration.contour.contours, written.exploration.contour.contours);
  EXPECT_EQ(read.exploration.contour.views, written.exploration.contour.views);
  EXPECT_EQ(read.exploration.contour.segmentation, written.exploration.contour.segmentation);
  EXPECT_EQ(read.exploration.contour.gain, written.exploration.contour.gain);
  EXPECT_EQ(read.exploration.scan, written.exploration.scan);
  EXPECT_EQ(read.free_flyer, written.free_flyer);
  EXPECT_EQ(read.arm, written.arm);
  EXPECT_EQ(read.arm_errors, written.arm_errors);
  EXPECT_EQ(effectiveToml(read).size() > 1000, true);
}

TEST(ConfigFile, DefaultsSurviveTheWayThroughAFile) {
  Settings read;
  applyToml(read, effectiveToml(Settings{}), "again");
  const Settings defaults;
  EXPECT_EQ(read.exploration.contour.contours, defaults.exploration.contour.contours);
  EXPECT_EQ(read.exploration.contour.segmentation, defaults.exploration.contour.segmentation);
  EXPECT_EQ(read.exploration.contour.gain, defaults.exploration.contour.gain);
  EXPECT_EQ(read.exploration.scan, defaults.exploration.scan);
  EXPECT_EQ(read.exploration.volume, defaults.exploration.volume);
  EXPECT_EQ(read.free_flyer, defaults.free_flyer);
  EXPECT_EQ(read.sensor, defaults.sensor);
}

TEST(ConfigFile, AnglesAreDegreesInFilesAndRadiansInside) {
  Settings settings;
  applyToml(settings, "[contours]\ngroup_angle_deg = 45\n", "a.toml");
  EXPECT_DOUBLE_EQ(settings.exploration.contour.contours.group_angle_rad, std::numbers::pi / 4);
  EXPECT_THAT(effectiveToml(Settings{}), HasSubstr("\ngroup_angle_deg = 30.0  # default"));
  EXPECT_THAT(effectiveToml(Settings{}), HasSubstr("\nexecuted_angle_deg = 10.0  # default"));
}

TEST(ConfigFile, LaterSourcesWinAndAreRemembered) {
  Settings settings;
  applyToml(settings, "[gain]\nthreshold = 500\nreduction = 2\n", "user.toml");
  applyToml(settings, "name = \"table\"\n[gain]\nthreshold = 600\n[[solid]]\nkind = \"box\"\n", "scene table",
            std::vector<std::string>{"name", "solid"});
  applyAssignment(settings, "gain.threshold=650");
  EXPECT_EQ(settings.exploration.contour.gain.gain_threshold, 650.0);
  EXPECT_EQ(settings.exploration.contour.gain.reduction, 2);
  EXPECT_EQ(settings.origin("gain.threshold"), "--set");
  EXPECT_EQ(settings.origin("gain.reduction"), "user.toml");
  EXPECT_EQ(settings.origin("gain.outside"), "default");
  const std::string text = effectiveToml(settings);
  EXPECT_THAT(text, HasSubstr("threshold = 650.0  # --set |"));
  EXPECT_THAT(text, HasSubstr("reduction = 2  # user.toml |"));
}

TEST(ConfigFile, UnknownKeysNameFileLineAndTheNearestKey) {
  EXPECT_EQ(tomlError("[camera]\nwidth = 640\n\n[gain]\ntreshold = 3\n"),
            "a.toml:5: unknown key 'gain.treshold'; did you mean 'gain.threshold'?");
  EXPECT_THAT(tomlError("qqqqqq = 1\n"), HasSubstr("a.toml:1: unknown key 'qqqqqq'; `vantage config`"));
  EXPECT_THAT(tomlError("[solid]\nname = 1\n"), HasSubstr("unknown key 'solid'"));
  EXPECT_THAT(tomlError("[gain]\nsolid = 1\n", {"solid"}), HasSubstr("unknown key 'gain.solid'"));
  EXPECT_THAT(setError("camera.widht=3"), HasSubstr("did you mean 'camera.width'?"));
  EXPECT_THAT(setError("camera=3"), HasSubstr("unknown key 'camera'"));
}

TEST(ConfigFile, ValuesOutOfRangeNameKeyValueAndRange) {
  EXPECT_EQ(tomlError("[camera]\nwidth = 0\n"),
            "a.toml:2: camera.width = 0 is out of range; allowed: 1 .. 8192");
  EXPECT_THAT(tomlError("[gain]\nthreshold = nan\n"), HasSubstr("gain.threshold = nan is out of range"));
  EXPECT_THAT(tomlError("[gain]\nthreshold = inf\n"), HasSubstr("gain.threshold = inf is out of range"));
  EXPECT_THAT(tomlError("[volume]\nsize = [10, 1, 10]\n"), HasSubstr("3 numbers in 2 .. 8192"));
  EXPECT_THAT(setError("dataset.quaternion_xyzw=[0, 0, 0, 0.9]"), HasSubstr("1 within 0.001"));
}

TEST(ConfigFile, WrongTypesNameKeyValueAndWhatIsAllowed) {
  EXPECT_THAT(tomlError("[camera]\nwidth = \"big\"\n"),
              HasSubstr("camera.width = \"big\" is not an integer; allowed: 1"));
  EXPECT_THAT(tomlError("[camera]\nwidth = 1.5\n"), HasSubstr("is not an integer"));
  EXPECT_THAT(tomlError("[gain]\noutside = \"glass\"\n"), HasSubstr("allowed: opaque | transparent"));
  EXPECT_THAT(tomlError("[gain]\nexclude_executed = 1\n"), HasSubstr("allowed: true | false"));
  EXPECT_THAT(tomlError("[volume]\nsize = [10, 10]\n"), HasSubstr("wrong number of entries"));
  EXPECT_THAT(tomlError("[volume]\nsize = [10, 10, 10.5]\n"), HasSubstr("holds a fraction"));
  EXPECT_THAT(tomlError("[volume]\nsize = [10, 10, \"x\"]\n"), HasSubstr("not a number"));
  EXPECT_THAT(tomlError("[volume.size]\nx = 1\n"), HasSubstr("volume.size is a table"));
  EXPECT_THAT(tomlError("camera = 3\n"), HasSubstr("camera is a section"));
  EXPECT_THAT(tomlError("[camera\nwidth = 3\n"), HasSubstr("a.toml:1: "));
}

TEST(ConfigFile, AnErrorLeavesTheSettingsAsTheyWere) {
  Settings settings;
  EXPECT_THROW(applyToml(settings, "[camera]\nheight = 10\nwidth = 0\n", "a.toml"), InputError);
  EXPECT_EQ(settings.camera.height, PinholeCamera{}.height);
  EXPECT_EQ(settings.origin("camera.height"), "default");
}

TEST(ConfigFile, AssignmentsTakeWordsWithAndWithoutQuotes) {
  Settings settings;
  applyAssignment(settings, "exploration.planner=standard");
  EXPECT_EQ(settings.planner(), "standard");
  applyAssignment(settings, " exploration.planner = \"contour\" ");
  EXPECT_EQ(settings.planner(), "contour");
  applyAssignment(settings, "views.distances_m=[0.6, 1]", "--distances");
  EXPECT_EQ(settings.exploration.contour.views.distances_m, (std::vector<double>{0.6, 1.0}));
  EXPECT_EQ(settings.origin("views.distances_m"), "--distances");
}

TEST(ConfigFile, AssignmentsThatAreNoneAreRefused) {
  EXPECT_THAT(setError("gain.threshold"), HasSubstr("has no '='"));
  EXPECT_THAT(setError("gain.threshold="), HasSubstr("no TOML value"));
  EXPECT_THAT(setError("gain.threshold=1\ncamera.width=3"), HasSubstr("no TOML value"));
  EXPECT_THAT(setError("=3"), HasSubstr("unknown key ''"));
}

TEST(ConfigFile, TheListHasEveryFieldWithItsDefault) {
  const auto list = listSettings();
  ASSERT_EQ(list.size(), config::fields().size());
  const auto width =
      std::find_if(list.begin(), list.end(), [](const auto& s) { return s.key == "camera.width"; });
  ASSERT_NE(width, list.end());
  EXPECT_EQ(width->default_value, "512");
  EXPECT_EQ(width->allowed, "1 .. 8192");
}

class ConfigFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("vantage_config_test_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_ / "vantage");
    setenv("XDG_CONFIG_HOME", folder_.c_str(), 1);
  }
  void TearDown() override {
    unsetenv("XDG_CONFIG_HOME");
    std::filesystem::remove_all(folder_);
  }
  std::filesystem::path folder_;
};

TEST_F(ConfigFolder, TheUserFileIsReadFromTheXdgFolder) {
  EXPECT_EQ(userConfigPath(), folder_ / "vantage" / "config.toml");
  Settings settings;
  applyUserConfig(settings);  // there is none yet
  EXPECT_EQ(settings.exploration.steps, 5);
  std::ofstream(userConfigPath()) << "[exploration]\nsteps = 9\n";
  applyUserConfig(settings);
  EXPECT_EQ(settings.exploration.steps, 9);
  EXPECT_EQ(settings.origin("exploration.steps"), userConfigPath().string());
}

TEST_F(ConfigFolder, FilesThatCannotBeReadAreNamed) {
  Settings settings;
  EXPECT_THAT(errorOf([&] { applyTomlFile(settings, folder_ / "no.toml"); }),
              HasSubstr("no.toml: cannot be read"));
  EXPECT_THAT(errorOf([&] { applyTomlFile(settings, folder_); }), HasSubstr("is a folder"));
}

TEST(Settings, DefaultsAreValid) {
  EXPECT_NO_THROW(Settings{}.validate());
}

TEST(Settings, ValuesThatDoNotFitTogetherAreRefused) {
  Settings settings;
  settings.exploration.workspace.min().x() = 2.0;
  EXPECT_THAT(errorOf([&] { settings.validate(); }), HasSubstr("workspace.min_m"));
  settings = {};
  settings.exploration.workspace.translate(Eigen::Vector3d(100, 0, 0));
  EXPECT_THAT(errorOf([&] { settings.validate(); }), HasSubstr("outside the mapped volume"));
  settings = {};
  settings.exploration.fusion.truncation_m = 0.001;
  EXPECT_THAT(errorOf([&] { settings.validate(); }), HasSubstr("truncation_m"));
  settings = {};
  settings.exploration.volume.size = {8192, 8192, 8192};
  EXPECT_THAT(errorOf([&] { settings.validate(); }), HasSubstr("volume.size"));
  settings = {};
  settings.camera.max_range_m = 0.1;
  EXPECT_THAT(errorOf([&] { settings.validate(); }), HasSubstr("max_range_m"));
  for (const Eigen::Vector3d& upper : {Eigen::Vector3d(-0.1, -0.1, 0.3), Eigen::Vector3d(0.1, 0.0, 0.3)}) {
    settings = {};  // two axes reversed give a volume above 0; one is flat
    settings.exploration.octree.object_box = Box(Eigen::Vector3d::Zero(), upper);
    EXPECT_THAT(errorOf([&] { settings.validate(); }), HasSubstr("octree.object_min_m is not below"));
  }
}

}  // namespace
}  // namespace vantage
