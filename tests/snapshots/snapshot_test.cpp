#include "snapshots/snapshot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <stop_token>

#include "core/gpu/egl_context.h"
#include "io/error.h"
#include "tests/support/synthetic_record.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A run file with two steps and a closing map in a folder of its own.
class SnapshotTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    unsetenv("DISPLAY");
    folder_ = fs::temp_directory_path() / ("vantage-snapshots-" + std::to_string(getpid()));
    fs::create_directories(folder_);
    run_ = folder_ / "small.vantage";
    const test::SyntheticRun made = test::makeSyntheticRun();
    RunWriter writer(run_, made.header);
    StepRecord record = made.record;
    writer.write(record);
    record.step = 2;
    record.changed_bricks = std::make_shared<std::vector<TsdfBrick>>();
    writer.write(record);
    StepRecord closing;
    closing.step = 3;
    closing.closing = true;
    closing.stage = Stage::Done;
    closing.planner = record.planner;
    closing.scan = record.scan;
    closing.depth = record.depth;
    closing.changed_bricks = record.changed_bricks;
    writer.write(closing);
    writer.finish("steps done");
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static SnapshotRequest request(const std::string& output) {
    SnapshotRequest wanted;
    wanted.width = 320;
    wanted.height = 200;
    wanted.output = (folder_ / output).string();
    return wanted;
  }
  static std::string messageOf(const SnapshotRequest& wanted) {
    try {
      takeSnapshots(run_, wanted);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no error";
  }

  static inline fs::path folder_, run_;
};

std::string bytesOf(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(SnapshotTest, AllStepsIntoAFolderMakeFivePicturesAStepAndASheet) {
  const auto files = takeSnapshots(run_, request("all"));
  EXPECT_EQ(files.size(), 2u * 5u + 2u + 1u);  // the closing map shows no planning
  for (const fs::path& file : files) {
    EXPECT_EQ(bytesOf(file).substr(1, 3), "PNG") << file;
    EXPECT_GT(fs::file_size(file), 2000u) << file;
  }
  EXPECT_TRUE(fs::exists(folder_ / "all" / "small-step01-views.png"));
  EXPECT_TRUE(fs::exists(folder_ / "all" / "small-step03-states.png"));
  EXPECT_TRUE(fs::exists(folder_ / "all" / "small-sheet.png"));
}

TEST_F(SnapshotTest, SamePictureTwiceIsTheSameFile) {
  SnapshotRequest wanted = request("a.png");
  wanted.step = 1;
  wanted.recipes = {"views"};
  takeSnapshots(run_, wanted);
  wanted.output = (folder_ / "b.png").string();
  takeSnapshots(run_, wanted);
  EXPECT_GT(bytesOf(folder_ / "a.png").size(), 1000u);
  EXPECT_EQ(bytesOf(folder_ / "a.png"), bytesOf(folder_ / "b.png"));
}

TEST_F(SnapshotTest, EndIsTheMapAfterTheLastScan) {
  SnapshotRequest wanted = request("end.png");
  wanted.step = SnapshotRequest::kEnd;
  wanted.recipes = {"states"};
  ASSERT_EQ(takeSnapshots(run_, wanted).size(), 1u);
  wanted.step = 3;
  wanted.output = (folder_ / "third.png").string();
  takeSnapshots(run_, wanted);
  EXPECT_EQ(bytesOf(folder_ / "end.png"), bytesOf(folder_ / "third.png"));
  wanted.recipes = {"views"};
  EXPECT_THAT(messageOf(wanted), HasSubstr("'views': it shows planning"));
}

TEST_F(SnapshotTest, EveryRecipeOfTheContourPlannerIsAnotherPicture) {
  SnapshotRequest wanted = request("recipes");
  wanted.step = 1;
  for (const Recipe& recipe : recipes())
    if (!recipe.foreign(PlannerKind::Contour) && recipe.name != "filters" && recipe.name != kArmRecipe)
      wanted.recipes.push_back(recipe.name);
  for (const char* name : {"normals", "poses", "labels", "roundness", "isolation", "counted"})
    EXPECT_THAT(wanted.recipes, testing::Contains(name));
  const auto files = takeSnapshots(run_, wanted);
  ASSERT_EQ(files.size(), wanted.recipes.size());
  for (std::size_t a = 0; a < files.size(); ++a)
    for (std::size_t b = a + 1; b < files.size(); ++b)
      EXPECT_NE(bytesOf(files[a]), bytesOf(files[b])) << files[a] << ", " << files[b];
}

TEST_F(SnapshotTest, RecipesOfPlanningLeaveTheLastMapOut) {
  SnapshotRequest wanted = request("planning-{step}.png");
  wanted.recipes = {"views"};
  EXPECT_EQ(takeSnapshots(run_, wanted).size(), 2u);
}

TEST_F(SnapshotTest, RecipeOfAFileIsDrawnUnderItsName) {
  std::ofstream(folder_ / "below.toml")
      << "layers = [\"workspace\", \"occupied\"]\n[camera]\nazimuth_deg = 20\n";
  SnapshotRequest wanted = request("own");
  wanted.step = 1;
  wanted.recipes = {(folder_ / "below.toml").string()};
  const auto files = takeSnapshots(run_, wanted);
  ASSERT_EQ(files.size(), 1u);
  EXPECT_EQ(files[0].filename(), "small-step01-below.png");
}

TEST_F(SnapshotTest, NamesAreFilledIn) {
  EXPECT_EQ(snapshotPath("x/{run}_{step}_{view}.png", "t", 3, "views"), fs::path("x/t_03_views.png"));
  EXPECT_EQ(snapshotPath("folder", "t", 12, "scene"), fs::path("folder/t-step12-scene.png"));
  EXPECT_THROW(snapshotPath("{stp}.png", "t", 1, "v"), InputError);
}

TEST_F(SnapshotTest, UnknownRecipeSuggestsTheNearest) {
  SnapshotRequest wanted = request("x.png");
  wanted.step = 1;
  wanted.recipes = {"segmets"};
  EXPECT_THAT(messageOf(wanted), HasSubstr("did you mean 'segments'?"));
}

TEST_F(SnapshotTest, MissingStepNamesTheRecordedOnes) {
  SnapshotRequest wanted = request("x.png");
  wanted.step = 9;
  wanted.recipes = {"scene"};
  EXPECT_THAT(messageOf(wanted), HasSubstr("there is no step 9; recorded: 1 .. 3"));
}

TEST_F(SnapshotTest, SeveralPicturesNeedNamesOfTheirOwn) {
  SnapshotRequest wanted = request("x.png");
  EXPECT_THAT(messageOf(wanted), HasSubstr("{step}"));
  wanted.step = 1;
  EXPECT_THAT(messageOf(wanted), HasSubstr("{view}"));
  wanted.width = 5;
  EXPECT_THAT(messageOf(wanted), HasSubstr("allowed: 160"));
}

TEST_F(SnapshotTest, FullDiskAndBadFoldersNameTheFile) {
  const RgbImage image(64, 64);
  EXPECT_THROW(writePng(image, "/proc/vantage/x.png"), std::runtime_error);
  if (fs::exists("/dev/full")) {
    try {
      RgbImage large(640, 640);
      for (std::size_t i = 0; i < large.pixels.size(); ++i)
        large.pixels[i] = static_cast<std::uint8_t>(i * i * 31 >> 3);
      writePng(large, "/dev/full");
      FAIL() << "a full disk went unnoticed";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr("/dev/full: "));
      EXPECT_THAT(error.what(), HasSubstr("No space left"));
    }
  }
}

TEST_F(SnapshotTest, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  RunControl control;
  control.stop = source.get_token();
  EXPECT_THROW(takeSnapshots(run_, request("stopped"), control), Cancelled);
}

}  // namespace
}  // namespace vantage
