#include "viewer/preferences.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>

#include "tests/support/process.h"

namespace vantage::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// Every field differs from its default.
Preferences unusual() {
  Preferences p;
  p.theme = ThemeName::HighContrast;
  p.font_scale = 1.35;
  p.window_width = 1717;
  p.window_height = 903;
  p.left_em = 17.25;
  p.right_em = 31.5;
  p.timeline_em = 9.125;
  p.show_left = p.show_right = p.show_timeline = p.show_inset = p.show_legend = false;
  p.keyboard_navigation = true;
  p.view.layers = {Layer::Workspace, Layer::Octree, Layer::DepthImage};
  p.view.style.unknown_opacity = 0.11;
  p.view.style.free_opacity = 0.013;
  p.view.style.saliency_max = 0.61;
  p.view.style.saliency_part = SaliencyPart::Isolation;
  p.view.style.isolation_distance_m = 0.07;
  p.view.style.ranked_views = 7;
  p.view.style.unreachable_views = 3;
  p.view.style.frustum_length_m = 0.23;
  p.view.style.slices = {SlicePlane{true, {}}, SlicePlane{false, 0.25}, SlicePlane{true, -0.125}};
  p.view.style.octree_level = 2;
  p.view.style.view_id = 17;
  p.view.style.coarse_rays = 1234;
  p.view.style.utility_factor = UtilityFactor::Distance;
  p.view.style.truth_opacity = 0.5;
  p.view.style.surface_opacity = 0.75;
  p.view.style.label_px = 19.0;
  p.view.style.line_scale = 1.7;
  p.view.style.color_map = ColorMap::Cividis;
  p.view.camera.azimuth_rad = 0.777;
  p.view.camera.elevation_rad = -0.3;
  p.view.camera.fov_rad = 0.61;
  p.view.camera.focus = CameraFocus::Segment;
  p.view.camera.zoom = 1.5;
  p.view.camera.front_m = 0.35;
  p.view.camera.height_share = 0.55;
  p.view.camera.eye = Eye{{0.5, 0.25, 2.0}, {0.0, 0.0, 0.5}, Eigen::Vector3d::UnitX(), 0.9};
  p.view.look(Layer::RankedViews) = {0.25, 2.0, ColorMap::Viridis};
  p.view.look(Layer::Unknown).opacity = 0.5;
  p.view.clip = Box(Eigen::Vector3d(-0.5, -0.25, 0.0), Eigen::Vector3d(0.5, 0.75, 0.4));
  p.eye = Eye{{1.5, -2.25, 0.75}, {0.1, 0.2, 0.3}, Eigen::Vector3d::UnitY(), 0.7};
  p.recent_files = {{"/nowhere/a \"quoted\" name.vantage", true}, {"tabletop", false}};
  p.bookmarks = {{"from above", *p.eye}, {"", Eye{{3, 2, 1}, {0, 0, 0}, Eigen::Vector3d::UnitZ(), 0.5}}};
  return p;
}

void expectEqual(const Eye& a, const Eye& b) {
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.focus, b.focus);
  EXPECT_EQ(a.up, b.up);
  EXPECT_NEAR(a.fov_rad, b.fov_rad, 1e-12);
}

void expectEqual(const ViewSettings& a, const ViewSettings& b) {
  EXPECT_EQ(a.layers, b.layers);
  EXPECT_EQ(a.style, b.style);
  EXPECT_NEAR(a.camera.azimuth_rad, b.camera.azimuth_rad, 1e-12);
  EXPECT_NEAR(a.camera.elevation_rad, b.camera.elevation_rad, 1e-12);
  EXPECT_NEAR(a.camera.fov_rad, b.camera.fov_rad, 1e-12);
  EXPECT_EQ(a.camera.focus, b.camera.focus);
  EXPECT_EQ(a.camera.zoom, b.camera.zoom);
  EXPECT_EQ(a.camera.front_m, b.camera.front_m);
  EXPECT_EQ(a.camera.height_share, b.camera.height_share);
  ASSERT_EQ(a.camera.eye.has_value(), b.camera.eye.has_value());
  if (a.camera.eye) expectEqual(*a.camera.eye, *b.camera.eye);
  EXPECT_EQ(a.looks, b.looks);
  ASSERT_EQ(a.clip.has_value(), b.clip.has_value());
  if (!a.clip) return;
  EXPECT_EQ(a.clip->min(), b.clip->min());
  EXPECT_EQ(a.clip->max(), b.clip->max());
}

void expectEqual(const Preferences& a, const Preferences& b) {
  EXPECT_EQ(a.theme, b.theme);
  for (const auto member :
       {&Preferences::font_scale, &Preferences::left_em, &Preferences::right_em, &Preferences::timeline_em})
    EXPECT_EQ(a.*member, b.*member);
  for (const auto member : {&Preferences::window_width, &Preferences::window_height})
    EXPECT_EQ(a.*member, b.*member);
  for (const auto member :
       {&Preferences::show_left, &Preferences::show_right, &Preferences::show_timeline,
        &Preferences::show_inset, &Preferences::show_legend, &Preferences::keyboard_navigation})
    EXPECT_EQ(a.*member, b.*member);
  expectEqual(a.view, b.view);
  ASSERT_EQ(a.eye.has_value(), b.eye.has_value());
  if (a.eye) expectEqual(*a.eye, *b.eye);
  ASSERT_EQ(a.recent_files.size(), b.recent_files.size());
  for (std::size_t i = 0; i < a.recent_files.size(); ++i) {
    EXPECT_EQ(a.recent_files[i].path, b.recent_files[i].path);
    EXPECT_EQ(a.recent_files[i].missing, b.recent_files[i].missing);
  }
  ASSERT_EQ(a.bookmarks.size(), b.bookmarks.size());
  for (std::size_t i = 0; i < a.bookmarks.size(); ++i) {
    EXPECT_EQ(a.bookmarks[i].name, b.bookmarks[i].name);
    expectEqual(a.bookmarks[i].eye, b.bookmarks[i].eye);
  }
}

TEST(Preferences, ReadBackAsTheyWereWritten) {
  const TemporaryFolder folder;
  std::string problem;
  for (const Preferences& written : {unusual(), Preferences()}) {
    savePreferences(folder / "a/b/inspector.toml", written);
    expectEqual(loadPreferences(folder / "a/b/inspector.toml", &problem), written);
    EXPECT_EQ(problem, "");
  }
  int files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder / "a/b")) ++files;
  EXPECT_EQ(files, 1) << "nothing is left beside the file";
}

TEST(Preferences, AMissingFileGivesDefaultsWithoutAWord) {
  const TemporaryFolder folder;
  std::string problem;
  expectEqual(loadPreferences(folder / "none.toml", &problem), Preferences());
  expectEqual(loadPreferences("", &problem), Preferences());
  EXPECT_EQ(problem, "");
  EXPECT_NO_THROW(savePreferences("", unusual()));
}

TEST(Preferences, UnknownKeysAreLeftAlone) {
  const TemporaryFolder folder;
  writeFile(folder / "p.toml",
            "from_the_future = 1\n[window]\nfont_scale = 1.5\nwings = 4\n[style]\nlabel_px = 20\nglow = "
            "true\n[moon]\n");
  std::string problem;
  const Preferences p = loadPreferences(folder / "p.toml", &problem);
  EXPECT_EQ(problem, "");
  EXPECT_EQ(p.font_scale, 1.5);
  EXPECT_EQ(p.view.style.label_px, 20.0);
}

TEST(Preferences, ABrokenPartFallsBackAndTheOthersStay) {
  const TemporaryFolder folder;
  const std::string good = "[style]\nlabel_px = 20\n";
  for (const std::string bad : {"[window]\nfont_scale = 99\n", "[window]\ntheme = \"pink\"\n", "window = 3\n",
                                "layers = [\"surfaces\"]\n", "layers = 4\n", "[eye]\nposition_m = [1, 2]\n",
                                "[clip]\nmin_m = [0, 0, 1]\nmax_m = [0, 0, 0]\n",
                                "[camera]\nelevation_deg = 500\n", "[looks.surface]\nopacity = -1\n",
                                "bookmark = 1\n", "recent_files = \"x\"\n", "[[bookmark]]\nname = \"x\"\n"}) {
    writeFile(folder / "p.toml", bad + good);
    std::string problem;
    const Preferences p = loadPreferences(folder / "p.toml", &problem);
    EXPECT_THAT(problem, AllOf(HasSubstr("p.toml"), HasSubstr("default"), HasSubstr("p.toml.broken"))) << bad;
    EXPECT_EQ(readFile(folder / "p.toml.broken"), bad + good);
    Preferences expected;
    expected.view.style.label_px = 20.0;
    expectEqual(p, expected);
  }
}

TEST(Preferences, ABrokenFileIsKeptAsideAndNeverThrows) {
  const TemporaryFolder folder;
  savePreferences(folder / "p.toml", unusual());
  const std::string whole = readFile(folder / "p.toml");
  for (std::size_t length = 0; length < whole.size(); length += 13) {
    for (const char junk : {'\0', '[', '\xff', '"'}) {
      writeFile(folder / "p.toml", whole.substr(0, length) + junk + whole.substr(length));
      EXPECT_NO_THROW(loadPreferences(folder / "p.toml")) << length;
    }
  }
  writeFile(folder / "p.toml", "[[[");
  std::string problem;
  expectEqual(loadPreferences(folder / "p.toml", &problem), Preferences());
  EXPECT_THAT(problem, HasSubstr("broken TOML"));
  EXPECT_EQ(readFile(folder / "p.toml.broken"), "[[[");
}

TEST(Preferences, KeepTheMostRecentFilesOnceEach) {
  const TemporaryFolder folder;
  Preferences p;
  for (int i = 0; i < 20; ++i) p.addRecent(folder / ("run" + std::to_string(i) + ".vantage"));
  ASSERT_EQ(p.recent_files.size(), Preferences::kMostRecent);
  EXPECT_EQ(p.recent_files[0].path, folder / "run19.vantage");
  p.addRecent(folder / "run15.vantage");
  ASSERT_EQ(p.recent_files.size(), Preferences::kMostRecent);
  EXPECT_EQ(p.recent_files[0].path, folder / "run15.vantage");
  EXPECT_EQ(p.recent_files[1].path, folder / "run19.vantage");

  writeFile(folder / "run15.vantage", "x");
  p.addRecent("tabletop");
  savePreferences(folder / "p.toml", p);
  const Preferences read = loadPreferences(folder / "p.toml");
  EXPECT_EQ(read.recent_files[0].path, "tabletop");
  EXPECT_FALSE(read.recent_files[0].missing) << "the name of a scene";
  EXPECT_FALSE(read.recent_files[1].missing);
  EXPECT_TRUE(read.recent_files[2].missing) << "kept, but marked";
  EXPECT_EQ(read.folder(), folder.path());
}

TEST(Preferences, AFileThatCannotBeWrittenKeepsItsContent) {
  const TemporaryFolder folder;
  const fs::path file = folder / "inspector.toml";
  savePreferences(file, unusual());
  const std::string before = readFile(file);
  ASSERT_NE(before, "");
  // Stands where the new content is written before it takes the place of the old one.
  fs::create_directories(file.string() + "." + std::to_string(::getpid()) + ".new/full");
  EXPECT_THROW(savePreferences(file, {}), std::runtime_error);
  EXPECT_EQ(readFile(file), before);
  EXPECT_THROW(savePreferences(file / "below a file.toml", {}), std::runtime_error);
  EXPECT_EQ(readFile(file), before);
}

TEST(Preferences, LieWhereTheSystemKeepsState) {
  const char* state = std::getenv("XDG_STATE_HOME");
  const char* home = std::getenv("HOME");
  const std::string old_state = state ? state : "", old_home = home ? home : "";
  ::setenv("XDG_STATE_HOME", "/some/state", 1);
  EXPECT_EQ(preferencesPath(), "/some/state/vantage/inspector.toml");
  ::unsetenv("XDG_STATE_HOME");
  ::setenv("HOME", "/someone", 1);
  EXPECT_EQ(preferencesPath(), "/someone/.local/state/vantage/inspector.toml");
  ::unsetenv("HOME");
  EXPECT_EQ(preferencesPath(), "");
  if (state) ::setenv("XDG_STATE_HOME", old_state.c_str(), 1);
  if (home) ::setenv("HOME", old_home.c_str(), 1);
}

}  // namespace
}  // namespace vantage::test
