#include "io/dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/dataset_support.h"

namespace vantage {
namespace {

using testing::HasSubstr;

class Dataset7Scenes : public DatasetTest {};
class DatasetTum : public DatasetTest {
 protected:
  void addTum() {
    for (const char* name : {"a", "b", "c"}) {
      std::filesystem::create_directories(folder_ / "depth");
      writeDepthPng(folder_ / "depth" / (std::string(name) + ".png"), wall(2.0f));
    }
    write("depth.txt", "# depth maps\n10.00 depth/a.png\n10.10 depth/b.png\n12.00 depth/c.png\n");
    write("rgb.txt", "10.015 rgb/a.png\n");
    write("groundtruth.txt",
          "# t x y z qx qy qz qw\n10.012 1 2 3 0 0 0 1\n9.99 7 7 7 0 0 0 1\n10.11 4 5 6 0 1 0 0\n");
  }
};
class DatasetToml : public DatasetTest {};
class DatasetSettings : public DatasetTest {};

TEST_F(Dataset7Scenes, FramesAreListedInAscendingNumberWithTheirPoses) {
  addSequence();
  write("frames/frame-000007.color.png", "colour");
  EXPECT_TRUE(looksLikeDataset(folder_));
  const Dataset dataset = openDataset(folder_);
  ASSERT_EQ(dataset.frames.size(), 3u);
  EXPECT_EQ(dataset.frames[0].number, 3);
  EXPECT_EQ(dataset.frames[1].number, 7);
  EXPECT_EQ(dataset.frames[2].number, 12);
  EXPECT_TRUE(dataset.frames[2].T_world_camera.isApprox(poseOf(12)));
  EXPECT_TRUE(dataset.frames[0].color_path.empty());
  EXPECT_EQ(dataset.frames[1].color_path.filename(), "frame-000007.color.png");
  EXPECT_EQ(dataset.layout, "frames");
  EXPECT_EQ(dataset.camera.width, 8);
  EXPECT_EQ(dataset.camera.height, 6);
  EXPECT_EQ(dataset.camera.fx, 10.0);
  EXPECT_EQ(dataset.camera.fy, 11.0);
  EXPECT_EQ(dataset.camera.cx, 3.5);
  EXPECT_EQ(dataset.camera.cy, 2.5);
  EXPECT_EQ(dataset.observations_per_frame, 10);
}

TEST_F(Dataset7Scenes, FramesMayLieInTheFolderItself) {
  addSequence("");
  write("camera-intrinsics.txt", "10 11 3.5 2.5\n");
  const Dataset dataset = openDataset(folder_);
  EXPECT_EQ(dataset.frames.size(), 3u);
  EXPECT_EQ(dataset.camera.fy, 11.0);
}

TEST_F(Dataset7Scenes, DepthIsInMetresAndZeroAnd65535AreInvalid) {
  addSequence();
  DepthImage image = wall(1.234f);
  image.at(0, 0) = DepthImage::kInvalid;
  writeDepthPng(folder_ / "frames/frame-000003.depth.png", image);
  const DepthImage read = loadDepth(openDataset(folder_), 0);
  EXPECT_FLOAT_EQ(read.at(1, 0), 1.234f);
  EXPECT_TRUE(std::isnan(read.at(0, 0)));
}

TEST_F(Dataset7Scenes, BrokenSequencesAreRefusedByFile) {
  const auto error = [&] { return errorOf([&] { openDataset(folder_); }); };
  EXPECT_THAT(error(), HasSubstr("is no data set"));
  EXPECT_FALSE(looksLikeDataset(folder_));
  addSequence();
  write("frames/frame-000007.pose.txt", "1 0 0 0\n0 1 x 0\n");
  EXPECT_THAT(error(), HasSubstr("frame-000007.pose.txt:2: 'x' is not a finite number"));
  write("frames/frame-000007.pose.txt", "1 0 0 0\n");
  EXPECT_THAT(error(), HasSubstr("frame-000007.pose.txt: 4 numbers; a pose is a 4x4 matrix"));
  write("frames/frame-000007.pose.txt", poseText(2.0 * poseOf(7).matrix()));
  EXPECT_THAT(error(), HasSubstr("frame-000007.pose.txt: the matrix is not a rigid transform"));
  write("frames/frame-000007.pose.txt", poseText(Eigen::Matrix4d::Constant(std::nan(""))));
  EXPECT_THAT(error(), HasSubstr("frame-000007.pose.txt:1: 'nan'"));
  std::filesystem::remove(folder_ / "frames/frame-000007.pose.txt");
  EXPECT_THAT(error(), HasSubstr("frame-000007.pose.txt: the pose of this frame is missing"));
  write("frames/frame-000007.pose.txt", poseText(poseOf(7).matrix()));
  EXPECT_NO_THROW(openDataset(folder_));
  addFrame(7, "again/");
  std::filesystem::copy_file(folder_ / "again/frame-000007.depth.png", folder_ / "frames/frame-7.depth.png");
  EXPECT_THAT(error(), HasSubstr("two frames of this number"));
}

TEST_F(Dataset7Scenes, ImagesOfAnotherSizeOrKindAreRefusedByFile) {
  addSequence();
  const auto error = [&] { return errorOf([&] { openDataset(folder_); }); };
  const auto image = folder_ / "frames/frame-000007.depth.png";
  writeDepthPng(image, wall(1.0f, 9, 6));
  EXPECT_THAT(error(), HasSubstr("frame-000007.depth.png: is 9x6; the first frame is 8x6"));
  writeBytePng(image, 8, 6, std::vector<std::uint8_t>(48, 1));
  EXPECT_THAT(error(), HasSubstr("frame-000007.depth.png: is not a depth image: 8 bit"));
  write("frames/frame-000007.depth.png", "JFIF");
  EXPECT_THAT(error(), HasSubstr("frame-000007.depth.png: is not a PNG image"));
  writeDepthPng(image, wall(1.0f));
  const Dataset dataset = openDataset(folder_);
  writeDepthPng(image, wall(1.0f, 9, 6));
  EXPECT_THAT(errorOf([&] { loadDepth(dataset, 1); }), HasSubstr("is 9x6; the camera has 8x6"));
}

TEST_F(Dataset7Scenes, BrokenIntrinsicsAreRefusedByFile) {
  addSequence();
  const auto error = [&](const std::string& text) {
    write("camera-intrinsics.txt", text);
    return errorOf([&] { openDataset(folder_); });
  };
  EXPECT_THAT(error("1 2 3"), HasSubstr("camera-intrinsics.txt: 3 numbers; a 3x3 matrix or fx fy cx cy"));
  EXPECT_THAT(error("10 0 3\n0 ten 2\n0 0 1\n"),
              HasSubstr("camera-intrinsics.txt:2: 'ten' is not a finite number"));
  EXPECT_THAT(error("10 1 3\n0 10 2\n0 0 1\n"), HasSubstr("is not a camera matrix"));
  EXPECT_THAT(error("0 10 3 2\n"), HasSubstr("the focal length is 0"));
  EXPECT_THAT(error("1 2 3 4 5 6 7 8 9 10"), HasSubstr("more than 9 numbers"));
  std::filesystem::remove(folder_ / "camera-intrinsics.txt");
  EXPECT_THAT(errorOf([&] { openDataset(folder_); }), HasSubstr("camera-intrinsics.txt: is missing"));
}

TEST_F(Dataset7Scenes, FoldersThatAreNoneAreRefused) {
  EXPECT_THAT(errorOf([&] { openDataset(folder_ / "no"); }), HasSubstr("no: is not a folder"));
  EXPECT_FALSE(looksLikeDataset(folder_ / "no"));
}

TEST_F(DatasetTum, PosesAreThoseNearestInTime) {
  addTum();
  write("camera-intrinsics.txt", "10 11 3.5 2.5\n");
  const Dataset dataset = openDataset(folder_);
  EXPECT_EQ(dataset.layout, "tum");
  ASSERT_EQ(dataset.frames.size(), 2u);
  // 9.99 is 10 ms away from the first frame, 10.012 is 12 ms away
  EXPECT_TRUE(dataset.frames[0].T_world_camera.translation().isApprox(Eigen::Vector3d(7, 7, 7)));
  EXPECT_TRUE(dataset.frames[1].T_world_camera.translation().isApprox(Eigen::Vector3d(4, 5, 6)));
  EXPECT_EQ(dataset.frames[0].color_path.filename(), "a.png");
  EXPECT_TRUE(dataset.frames[1].color_path.empty());
  ASSERT_EQ(dataset.warnings.size(), 1u);
  EXPECT_THAT(dataset.warnings[0], HasSubstr("1 frames have no pose within 0.02 s"));
  EXPECT_FLOAT_EQ(loadDepth(dataset, 0).at(0, 0), 0.4f);  // 2000 counts of 0.2 mm
}

TEST_F(DatasetTum, IntrinsicsHaveADefaultAndAWarning) {
  addTum();
  const Dataset dataset = openDataset(folder_);
  EXPECT_EQ(dataset.camera.fx, 525.0);
  EXPECT_THAT(dataset.warnings.back(), HasSubstr("no camera-intrinsics.txt"));
}

TEST_F(DatasetTum, BrokenListsAreRefusedByLine) {
  addTum();
  const auto error = [&] { return errorOf([&] { openDataset(folder_); }); };
  write("groundtruth.txt", "10.0 1 2 3 0 0 0 1\n10.1 1 2 3 0 0 0\n");
  EXPECT_THAT(error(), HasSubstr("groundtruth.txt:2: expected a time stamp and 7 more"));
  write("groundtruth.txt", "10.0 1 2 3 0 0 0 0.9\n");
  EXPECT_THAT(error(), HasSubstr("groundtruth.txt:1: the quaternion has length 0.9"));
  write("groundtruth.txt", "10.0 1 2 east 0 0 0 1\n");
  EXPECT_THAT(error(), HasSubstr("groundtruth.txt:1: 'east' is not a finite number"));
  write("groundtruth.txt", "99 1 2 3 0 0 0 1\n");
  EXPECT_THAT(error(), HasSubstr("no frame has a pose"));
}

TEST_F(DatasetToml, StatesPatternsUnitsPosesAndPlacement) {
  for (const int number : {1, 2}) {
    const std::string text = std::to_string(number);
    std::filesystem::create_directories(folder_ / "d");
    writeDepthPng(folder_ / ("d/z_" + text + ".png"), wall(2.0f));
    write("p/" + text + ".mat", poseText(poseOf(number).matrix()));
  }
  const std::string description = R"(
layout = "frames"
depth_pattern = "d/z_{number}.png"
pose_pattern = "p/{number}.mat"
depth_unit_m = 0.0005
invalid_depth = [7]
pose_convention = "world_to_camera"
range_m = [0.2, 3]
observations_per_frame = 4
[camera]
fx = 10
fy = 11
cx = 3
cy = 2
[T_world_dataset]
matrix = [[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]
[bounds]
min_m = [-1, -2, -3]
max_m = [1, 2, 3]
)";
  const auto check = [](const Dataset& dataset) {
    ASSERT_EQ(dataset.frames.size(), 2u);
    const Eigen::Vector3d expected = Eigen::Vector3d(5, 6, 7) + Eigen::Vector3d(0, -0.2, 0);
    EXPECT_TRUE(dataset.frames[1].T_world_camera.translation().isApprox(expected));
    EXPECT_FLOAT_EQ(loadDepth(dataset, 0).at(0, 0), 1.0f);
    EXPECT_EQ(dataset.camera.min_range_m, 0.2);
    EXPECT_EQ(dataset.camera.max_range_m, 3.0);
    EXPECT_EQ(dataset.camera.cy, 2.0);
    EXPECT_EQ(dataset.observations_per_frame, 4);
    ASSERT_TRUE(dataset.bounds.has_value());
    EXPECT_EQ(dataset.bounds->max(), Eigen::Vector3d(1, 2, 3));
  };
  const auto elsewhere = write("overlay/other.toml", description);
  check(openDataset(folder_, elsewhere));
  write("dataset.toml", description);
  check(openDataset(folder_));
}

TEST_F(DatasetToml, MistakesAreRefusedByFileAndLine) {
  addSequence();
  const auto error = [&](const std::string& text) {
    write("dataset.toml", text);
    return errorOf([&] { openDataset(folder_); });
  };
  EXPECT_THAT(error("\ndepth_patern = \"x\"\n"),
              HasSubstr("dataset.toml:2: unknown key 'depth_patern'; did you mean 'depth_pattern'?"));
  EXPECT_THAT(error("[bounds]\nmin_m = [1, 1, 1]\nmax_m = [0, 2, 2]\n"),
              HasSubstr("bounds.min_m is not usable"));
  EXPECT_THAT(error("range_m = [3, 1]\n"), HasSubstr("dataset.toml:1: range_m is not usable"));
  EXPECT_THAT(error("layout = \"rosbag\"\n"), HasSubstr("\"frames\" | \"tum\""));
  EXPECT_THAT(error("pose_convention = 3\n"), HasSubstr("a text in quotes"));
  EXPECT_THAT(error("depth_unit_m = 0\n"), HasSubstr("depth_unit_m is not usable"));
  EXPECT_THAT(error("depth_pattern = \"a.png\"\n"), HasSubstr("has no {number}"));
  EXPECT_THAT(error("depth_pattern = \"frames/x-{number}.png\"\n"), HasSubstr("the data set is empty"));
  EXPECT_THAT(error("[T_world_dataset]\nquaternion_xyzw = [0, 0, 0, 0.5]\n"),
              HasSubstr("length 1 within 0.001"));
  EXPECT_THAT(error("[T_world_dataset]\nmatrix = [[1, 0, 0, 0]]\n"), HasSubstr("rigid transform"));
  EXPECT_THAT(error("[camera]\nfx = 3\n"), HasSubstr("fx, fy, cx and cy together"));
  EXPECT_THAT(error("layout = \n"), HasSubstr("dataset.toml:1: "));
  EXPECT_THAT(errorOf([&] { openDataset(folder_, folder_ / "no.toml"); }),
              HasSubstr("no.toml: cannot be read"));
}

TEST_F(DatasetSettings, WorkspaceIsWhatWasMeasuredAndTheVolumeCoversIt) {
  addSequence();
  const Dataset dataset = openDataset(folder_);
  const Settings settings = settingsForDataset(dataset);
  const Box& workspace = settings.exploration.workspace;
  EXPECT_NEAR(workspace.center().z(), 2.0, 0.02);
  EXPECT_TRUE(settings.exploration.volume.bounds().contains(workspace));
  EXPECT_LE(settings.exploration.volume.count(), 40'000'000u);
  EXPECT_EQ(settings.exploration.scan.initial_frames, 3);
  EXPECT_EQ(settings.exploration.scan.frames, 1);
  EXPECT_EQ(settings.exploration.fusion.observations_per_frame, 10);
  EXPECT_FALSE(settings.exploration.enforce_reachability);
  EXPECT_EQ(settings.exploration.contour.views.distances_m, std::vector<double>{2.0});
  EXPECT_EQ(settings.origin("camera.width"), "data set");
  EXPECT_EQ(settings.origin("gain.threshold"), "default");
  EXPECT_NO_THROW(settings.validate());
}

TEST_F(DatasetSettings, LargeBoundsGiveLargerVoxelsAndAllThatFollowsThem) {
  addSequence();
  Dataset dataset = openDataset(folder_);
  dataset.bounds = Box(Eigen::Vector3d(-20, -20, 0), Eigen::Vector3d(20, 20, 5));
  const Settings settings = settingsForDataset(dataset);
  EXPECT_LE(settings.exploration.volume.count(), 40'000'000u);
  EXPECT_GT(settings.exploration.volume.count(), 30'000'000u);
  EXPECT_TRUE(settings.exploration.volume.bounds().contains(*dataset.bounds));
  EXPECT_GT(settings.exploration.fusion.truncation_m, 5.0 * settings.exploration.volume.voxel_size_m);
  EXPECT_GT(settings.exploration.contour.segmentation.voxel_m, settings.exploration.volume.voxel_size_m);
  EXPECT_NO_THROW(settings.validate());
}

TEST_F(DatasetSettings, SequencesWithoutAnyDepthAreRefused) {
  addSequence();
  for (const int number : {3, 7, 12})
    writeDepthPng(folder_ / "frames" / (frameName(number) + ".depth.png"), DepthImage(kWidth, kHeight));
  EXPECT_THAT(errorOf([&] { settingsForDataset(openDataset(folder_)); }), HasSubstr("no valid depth"));
}

TEST_F(DatasetSettings, PlacingTurnsEveryPoseAndKeepsRelativeOnes) {
  addSequence();
  Dataset dataset = openDataset(folder_);
  const Pose T = makePose({1, 2, 3}, Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5));
  placeDataset(dataset, Pose(Eigen::Translation3d(9, 9, 9)));
  placeDataset(dataset, T);
  EXPECT_TRUE(dataset.frames[0].T_world_camera.isApprox(T * poseOf(3)));
  EXPECT_TRUE(dataset.T_world_dataset.isApprox(T));
  EXPECT_TRUE(settingsForDataset(dataset).T_world_dataset().isApprox(T));
}

TEST(DatasetRecorded, TheTraySequenceOpensWithAllItsFrames) {
  VANTAGE_RECORDED(folder, "rgbd_ur5_tray");
  const Dataset dataset = openDataset(folder);
  ASSERT_EQ(dataset.frames.size(), 24u);
  EXPECT_EQ(dataset.frames.front().number, 150);
  EXPECT_EQ(dataset.frames.back().number, 173);
  EXPECT_NEAR(dataset.camera.fx, 532.58, 1e-9);
  const Settings settings = settingsForDataset(dataset);
  // the tray, as its authors' own reconstruction places it
  EXPECT_TRUE(settings.exploration.workspace.contains(Eigen::Vector3d(-0.06, -0.35, 0.05)));
  EXPECT_LT(settings.exploration.workspace.sizes().maxCoeff(), 1.5);
}

TEST(DatasetRecorded, TheBoxSequenceOpensWithAllItsFrames) {
  VANTAGE_RECORDED(folder, "rgbd_realsense_box");
  const Dataset dataset = openDataset(folder);
  ASSERT_EQ(dataset.frames.size(), 50u);
  for (std::size_t i = 0; i < dataset.frames.size(); i += 10) {
    const DepthImage depth = loadDepth(dataset, i);
    const auto valid = std::count_if(depth.depth_m.begin(), depth.depth_m.end(), DepthImage::valid);
    EXPECT_NEAR(static_cast<double>(valid) / (640 * 480), 0.36, 0.05);
  }
}

}  // namespace
}  // namespace vantage
