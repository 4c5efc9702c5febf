#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <set>
#include <thread>

#include "core/volume/tsdf_volume.h"
#include "io/dataset.h"
#include "tests/io/dataset_support.h"
#include "tests/support/bag_sequence.h"

namespace vantage {
namespace {

using test::BagPacking;
using test::BagSequence;
using test::BagWriter;
using test::RosImage;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class BagDataset : public FolderTest {
 protected:
  std::string bag() const { return folder_ / "x.bag"; }

  Dataset open(const BagSequence& sequence, BagPacking packing = BagPacking::None) const {
    sequence.write(bag(), packing);
    return openDataset(bag());
  }
  std::string refusal(const BagSequence& sequence) const {
    return errorOf([&] { open(sequence); });
  }
  /// The same frames as files.
  Dataset folderOf(int frames) const {
    std::filesystem::create_directories(folder_ / "files");
    for (int n = 0; n < frames; ++n) {
      const std::string name = "files/frame-00000" + std::to_string(n);
      writeDepthPng(folder_ / (name + ".depth.png"), BagSequence::depthOfFrame(n));
      write(name + ".pose.txt", poseText(BagSequence::poseOfFrame(n).matrix()));
    }
    write("files/camera-intrinsics.txt", "60 0 31.5\n0 61 23.5\n0 0 1\n");
    return openDataset(folder_ / "files");
  }
  static void expectSameDepth(const DepthImage& a, const DepthImage& b) {
    ASSERT_EQ(a.depth_m.size(), b.depth_m.size());
    for (std::size_t i = 0; i < a.depth_m.size(); ++i) {
      if (std::isnan(b.depth_m[i]))
        EXPECT_TRUE(std::isnan(a.depth_m[i])) << i;
      else
        EXPECT_EQ(a.depth_m[i], b.depth_m[i]) << i;
    }
  }
  static TsdfVolume fused(const Dataset& dataset) {
    TsdfVolume volume(GridGeometry{{-0.5, -1.0, -0.6}, 0.02, {110, 100, 80}});
    FusionConfig fusion;
    fusion.truncation_m = 0.06;
    for (std::size_t n = 0; n < dataset.frames.size(); ++n)
      fuseDepth(volume, loadDepth(dataset, n), dataset.camera, dataset.frames[n].T_world_camera, fusion);
    return volume;
  }
};
class BagPoses : public BagDataset {};
class BagDescription : public BagDataset {};
class BagRefusal : public BagDataset {};

TEST_F(BagDataset, GivesWhatTheSameFramesGiveAsFilesHoweverItIsPacked) {
  const Dataset files = folderOf(6);
  const TsdfVolume expected = fused(files);
  ASSERT_GT(std::ranges::count_if(expected.voxels(), [](const TsdfVoxel& v) { return v.weight > 0; }), 1000);
  for (const BagPacking packing : {BagPacking::None, BagPacking::Bz2, BagPacking::Lz4}) {
    for (const std::string encoding : {"16UC1", "mono16", "32FC1"}) {
      BagSequence sequence;
      sequence.encoding = encoding;
      const Dataset dataset = open(sequence, packing);
      EXPECT_EQ(dataset.layout, "rosbag");
      EXPECT_THAT(dataset.warnings, testing::IsEmpty());
      ASSERT_EQ(dataset.frames.size(), files.frames.size());
      EXPECT_EQ(dataset.camera.fy, files.camera.fy);
      EXPECT_EQ(dataset.camera.width, files.camera.width);
      for (std::size_t n = 0; n < files.frames.size(); ++n) {
        EXPECT_EQ(dataset.frames[n].number, static_cast<int>(n));
        const auto& pose = dataset.frames[n].T_world_camera;
        EXPECT_TRUE(pose.isApprox(files.frames[n].T_world_camera, 1e-9)) << n;
        expectSameDepth(loadDepth(dataset, n), loadDepth(files, n));
      }
      const TsdfVolume volume = fused(dataset);
      EXPECT_TRUE(std::ranges::equal(volume.voxels(), expected.voxels()));
    }
  }
}

TEST_F(BagDataset, IsKnownByItsEndingAndByItsContent) {
  BagSequence().write(bag());
  EXPECT_TRUE(looksLikeDataset(bag()));
  EXPECT_TRUE(isDatasetPath(folder_ / "none.bag")) << "so that its absence is what is said";
  EXPECT_FALSE(looksLikeDataset(folder_ / "none.bag"));
  std::filesystem::copy_file(bag(), folder_ / "recording");
  EXPECT_TRUE(looksLikeDataset(folder_ / "recording"));
  EXPECT_EQ(openDataset(folder_ / "recording").frames.size(), 6u);
  EXPECT_FALSE(isDatasetPath(write("notes.txt", "#ROSBA")));
}

TEST_F(BagDataset, ServesImagesToSeveralThreads) {
  BagSequence sequence;
  sequence.frames = 20;
  const Dataset dataset = open(sequence, BagPacking::Lz4);
  std::vector<std::thread> threads;
  std::array<bool, 4> right{};
  for (std::size_t t = 0; t < right.size(); ++t)
    threads.emplace_back([&, t] {
      right[t] = true;
      for (int i = 0; i < 40; ++i) {
        const int n = static_cast<int>((7 * i + 5 * t) % 20);
        if (loadDepth(dataset, n).at(20, 20) != BagSequence::depthOfFrame(n).at(20, 20)) right[t] = false;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(right, testing::Each(true));
}

TEST_F(BagDataset, WarnsOfDistortionAndOfAChangingCamera) {
  BagSequence sequence;
  sequence.D = {0.1, 0, 0, 0, 0};
  const auto warnings = open(sequence).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("depth images are taken as rectified"));
  sequence.D = {};
  sequence.more = [](BagWriter& writer) {
    writer.add(test::RosCameraInfo{"/camera/depth/camera_info", 64, 48, {61, 0, 31, 0, 61, 23, 0, 0, 1}, {}});
  };
  const Dataset changed = open(sequence);
  ASSERT_EQ(changed.warnings.size(), 1u);
  EXPECT_THAT(changed.warnings[0], HasSubstr("changes; its first message is taken"));
  EXPECT_EQ(changed.camera.fx, 60.0);
}

TEST_F(BagPoses, AreInterpolatedBetweenTransforms) {
  BagSequence sequence;
  sequence.tf_step_s = 0.2;  // the path is a straight line at constant speed, turning at constant rate
  const Dataset dataset = open(sequence);
  ASSERT_EQ(dataset.frames.size(), 5u) << "the last image is later than the last transform";
  ASSERT_EQ(dataset.warnings.size(), 1u);
  EXPECT_THAT(dataset.warnings[0], HasSubstr("does not cover the time of 1 of 6 images"));
  for (int n = 0; n < 5; ++n)
    EXPECT_TRUE(dataset.frames[n].T_world_camera.isApprox(BagSequence::poseOfFrame(n), 1e-9)) << n;
}

TEST_F(BagPoses, ImagesOfOneTimeAreAllServedAndThoseWithoutATimeAreLeftOut) {
  BagSequence sequence;
  sequence.change = [](int n, RosImage& image) {
    if (n < 3) image.stamp_ns = BagSequence::stampOf(0.0);  // frozen
    if (n == 4) image.stamp_ns = 0;
  };
  const Dataset dataset = open(sequence);
  ASSERT_EQ(dataset.frames.size(), 5u);
  EXPECT_EQ(dataset.frames[4].number, 5);
  EXPECT_TRUE(dataset.frames[2].T_world_camera.isApprox(BagSequence::poseOfFrame(0), 1e-9));
  EXPECT_NE(loadDepth(dataset, 2).at(33, 24), loadDepth(dataset, 2).at(0, 24));
  EXPECT_THAT(dataset.warnings, testing::UnorderedElementsAre(HasSubstr("2 images have the time of another"),
                                                              HasSubstr("of 1 of 6 images")));
}

TEST_F(BagPoses, AStaticTreeHoldsAtAllTimes) {
  BagSequence sequence;
  sequence.with_tf = false;
  sequence.change = [](int n, RosImage& image) {
    image.stamp_ns = n % 2 == 0 ? 0 : 4'000'000'000'000'000'000;
  };
  const Dataset dataset = open(sequence);
  ASSERT_EQ(dataset.frames.size(), 6u);
  EXPECT_TRUE(dataset.frames[3].T_world_camera.isApprox(BagSequence::poseOfCamera(), 1e-9));
}

TEST_F(BagPoses, OddTransformsHarmNothing) {
  BagSequence sequence;
  sequence.more = [](BagWriter& bag) {
    const std::int64_t t = BagSequence::stampOf(0.2);
    const double nan = std::nan("");
    bag.add(test::RosTransform{"world", "base", t, {nan, 0, 0}, {0, 0, 0, 1}});
    bag.add(test::RosTransform{"world", "base", t, {0, 0, 0}, {0, 0, 0, 0}});
    bag.add(test::RosTransform{"base", "base", t});
    bag.add(test::RosTransform{"", "base", t});
    bag.add(test::RosTransform{"world", "base", t, {9, 9, 9}});  // a second one of the same time
    bag.add(test::RosTransform{"elsewhere", "thing", 0});        // another tree
    bag.add(test::RosTransform{"thing", "elsewhere", 1});        // that goes round
    bag.add(test::RosTransform{"world", "base", 4'200'000'000'000'000'000, {9, 9, 9}});  // in a far future
  };
  testing::internal::CaptureStderr();
  const Dataset dataset = open(sequence);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_EQ(dataset.frames.size(), 6u);
  EXPECT_TRUE(dataset.frames[2].T_world_camera.isApprox(BagSequence::poseOfFrame(2), 1e-9));
  ASSERT_EQ(dataset.warnings.size(), 1u);
  EXPECT_THAT(dataset.warnings[0], HasSubstr("4 transforms of tf are not usable"));
}

TEST_F(BagDescription, ChoosesTopicsFrameAndAllThatADataSetStates) {
  BagSequence sequence;
  sequence.more = [](BagWriter& bag) {
    RosImage other = BagSequence().imageOf(0);
    other.topic = "/ir/image_raw";
    other.encoding = "mono16";
    bag.add(other);
  };
  EXPECT_THAT(refusal(sequence),
              AllOf(HasSubstr("several depth topics: '/camera/depth/image_raw', '/ir/image_raw'"),
                    HasSubstr("in x.bag.toml beside it: depth_topic = ")));
  const auto described = write("x.bag.toml", R"(
depth_topic = "/ir/image_raw"
camera_info_topic = "/camera/depth/camera_info"
fixed_frame = "base"
depth_unit_m = 0.002
invalid_depth = [1001]
range_m = [0.2, 3]
observations_per_frame = 4
[T_world_dataset]
position_m = [1, 2, 3]
[bounds]
min_m = [-1, -2, -3]
max_m = [1, 2, 3]
)");
  const auto check = [](const Dataset& dataset) {
    ASSERT_EQ(dataset.frames.size(), 1u);
    EXPECT_TRUE(dataset.frames[0].T_world_camera.isApprox(
        Pose(Eigen::Translation3d(1, 2, 3)) * BagSequence::poseOfCamera(), 1e-9));
    EXPECT_FLOAT_EQ(loadDepth(dataset, 0).at(2, 0), 2.004f);
    EXPECT_TRUE(std::isnan(loadDepth(dataset, 0).at(1, 0)));
    EXPECT_EQ(dataset.camera.max_range_m, 3.0);
    EXPECT_EQ(dataset.observations_per_frame, 4);
    ASSERT_TRUE(dataset.bounds.has_value());
  };
  check(openDataset(bag()));
  std::filesystem::rename(described, folder_ / "other.toml");
  check(openDataset(bag(), folder_ / "other.toml"));
}

TEST_F(BagDescription, StatesTheCameraWhereTheRecordingDoesNot) {
  BagSequence sequence;
  sequence.with_info = false;
  write("x.bag.toml", "[camera]\nfx = 50\nfy = 51\ncx = 30\ncy = 20\n");
  EXPECT_EQ(open(sequence).camera.fy, 51.0);
  write("x.bag.toml", "intrinsics = \"k.txt\"\n");
  write("k.txt", "40 41 30 20\n");
  EXPECT_EQ(open(sequence).camera.fy, 41.0);
}

TEST_F(BagDescription, MistakesAreRefusedByFileAndLine) {
  BagSequence sequence;
  sequence.more = [](BagWriter& bag) { bag.addText("/chatter"); };
  const auto error = [&](const std::string& text) {
    write("x.bag.toml", text);
    return refusal(sequence);
  };
  EXPECT_THAT(error("\ndepth_topc = \"x\"\n"),
              HasSubstr("x.bag.toml:2: unknown key 'depth_topc'; did you mean "
                        "'depth_topic'?"));
  EXPECT_THAT(error("depth_pattern = \"x{number}.png\"\n"), HasSubstr("unknown key 'depth_pattern'"));
  EXPECT_THAT(error("depth_topic = \"/none\"\n"), AllOf(HasSubstr("holds no messages of depth_topic '/none'"),
                                                        HasSubstr("'/camera/depth/image_raw (16UC1)'")));
  EXPECT_THAT(error("depth_topic = \"/chatter\"\n"), HasSubstr("holds no depth but 'std_msgs/String'"));
  EXPECT_THAT(error("camera_info_topic = \"/tf\"\n"), HasSubstr("holds no camera_info '/tf', only "));
  EXPECT_THAT(error("fixed_frame = \"word\"\n"),
              HasSubstr("no frame 'word', which fixed_frame names; did you "
                        "mean 'world'?"));
  EXPECT_THAT(error("fixed_frame = 3\n"), HasSubstr("a text in quotes"));
  write("frames/dataset.toml", "depth_topic = \"/a\"\n");
  EXPECT_THAT(errorOf([&] { openDataset(folder_ / "frames"); }), HasSubstr("unknown key 'depth_topic'"));
}

TEST_F(BagRefusal, WhatIsNoBagOrNotWholeIsNamed) {
  const auto error = [&] { return errorOf([&] { openDataset(bag()); }); };
  EXPECT_THAT(error(), HasSubstr("x.bag: cannot be read; check that the file exists"));
  for (const std::string text : {"", "#", "a text\n", "#ROSBAG"}) {
    write("x.bag", text);
    EXPECT_THAT(error(), HasSubstr("x.bag: is not a bag of ROS 1")) << text;
  }
  write("x.bag", "#ROSBAG V1.2\n");
  EXPECT_THAT(error(), HasSubstr("another format than 2.0"));
  BagSequence().write(bag());
  const std::string whole = read("x.bag");
  std::set<std::string> said;
  for (std::size_t size = 13; size < whole.size(); size += 1 + size / 40) {
    write("x.bag", whole.substr(0, size));
    said.insert(error());
  }
  EXPECT_THAT(said, testing::Each(HasSubstr("rosbag reindex")));
  ASSERT_EQ(::mkfifo((folder_ / "pipe.bag").c_str(), 0600), 0);
  EXPECT_THAT(errorOf([&] { openDataset(folder_ / "pipe.bag"); }), HasSubstr("is not a regular file"));
}

TEST_F(BagRefusal, UnindexedAndEncryptedBagsAreNamed) {
  BagSequence().write(bag());
  std::string text = read("x.bag");
  const std::size_t index = text.find("index_pos=") + 10;
  write("x.bag", text.substr(0, index) + std::string(8, '\0') + text.substr(index + 8));
  EXPECT_THAT(errorOf([&] { openDataset(bag()); }), HasSubstr("has no index, its recording was not ended"));

  const std::string field = "encryptor=rosbag/AesCbcEncryptor";  // goes into the header's padding
  std::uint32_t header = 0, padding = 0, length = static_cast<std::uint32_t>(field.size());
  std::memcpy(&header, &text[13], 4);
  std::memcpy(&padding, &text[17 + header], 4);
  const std::uint32_t longer = header + 4 + length, shorter = padding - 4 - length;
  const auto bytes = [](std::uint32_t x) { return std::string(reinterpret_cast<const char*>(&x), 4); };
  write("x.bag", text.substr(0, 13) + bytes(longer) + text.substr(17, header) + bytes(length) + field +
                     bytes(shorter) + text.substr(21 + header + 4 + length));
  EXPECT_THAT(errorOf([&] { openDataset(bag()); }), HasSubstr("is encrypted"));
}

TEST_F(BagRefusal, DamageIsRefusedOrHarmless) {
  int refused = 0, harmless = 0;
  std::uint32_t random = 1;
  const auto next = [&] { return random = random * 1664525u + 1013904223u, random >> 8; };
  for (const BagPacking packing : {BagPacking::None, BagPacking::Bz2, BagPacking::Lz4}) {
    BagSequence().write(bag(), packing);
    const std::string whole = read("x.bag");
    for (int round = 0; round < 300; ++round) {
      std::string text = whole;
      const std::size_t from = round % 2 == 0 ? 4117 : text.size() - text.size() / 6;  // chunks, index
      for (int k = 0; k < 1 + round % 5; ++k)
        text[from + next() % (text.size() - from)] = static_cast<char>(round % 3 == 0 ? 0xff : next());
      write("x.bag", text);
      try {
        const Dataset dataset = openDataset(bag());
        for (std::size_t n = 0; n < dataset.frames.size(); ++n) loadDepth(dataset, n);
        ++harmless;
      } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(harmless, 10);
}

TEST_F(BagRefusal, RecordingsWithoutDepthAreToldWhatIsThere) {
  BagSequence sequence;
  sequence.encoding = "rgb8";
  EXPECT_THAT(refusal(sequence),
              AllOf(HasSubstr("holds no depth images"), HasSubstr("'/camera/depth/image_raw (rgb8)'"),
                    HasSubstr("'/tf (tf2_msgs/TFMessage)'")));
  sequence.frames = 0;
  sequence.more = [](BagWriter& bag) { bag.addCompressedImage("/camera/depth/image_raw/compressedDepth"); };
  EXPECT_THAT(refusal(sequence), AllOf(HasSubstr("depth only in compressed images"), HasSubstr("republish")));
  write("x.bag.toml", "depth_topic = \"/camera/depth/image_raw/compressedDepth\"\n");
  EXPECT_THAT(refusal(sequence), HasSubstr("is compressed"));
  { BagWriter empty(folder_ / "y.bag"); }
  EXPECT_THAT(errorOf([&] { openDataset(folder_ / "y.bag"); }), HasSubstr("it holds nothing"));
}

TEST_F(BagRefusal, CamerasThatAreNoneAreRefused) {
  BagSequence sequence;
  for (const double bad : {0.0, std::nan(""), -60.0}) {
    sequence.K[0] = bad;
    EXPECT_THAT(refusal(sequence),
                AllOf(HasSubstr("is no camera matrix"), HasSubstr("State [camera] in x.bag.toml")));
  }
  sequence.with_info = false;
  EXPECT_THAT(refusal(sequence), HasSubstr("holds no camera_info '/camera/depth/camera_info', only nothing"));
  sequence.more = [](BagWriter& bag) {
    bag.add(test::RosCameraInfo{"/camera/depth/camera_info", 32, 24, {60, 0, 3, 0, 61, 2, 0, 0, 1}, {}});
  };
  EXPECT_THAT(refusal(sequence), HasSubstr("is of images of 32x24, those recorded are 64x48"));
}

TEST_F(BagRefusal, RecordingsWithoutPosesAreRefused) {
  BagSequence sequence;
  sequence.with_tf = sequence.with_static_tf = false;
  EXPECT_THAT(refusal(sequence), HasSubstr("holds no tf"));
  sequence.with_tf = true;
  EXPECT_THAT(refusal(sequence), HasSubstr("its tf has no frame 'camera', in which the depth images are"));
  sequence.with_static_tf = true;
  sequence.change = [](int, RosImage& image) { image.frame.clear(); };
  EXPECT_THAT(refusal(sequence), HasSubstr("state no frame_id"));
  sequence.change = [](int, RosImage& image) { image.stamp_ns += 60'000'000'000; };
  EXPECT_THAT(refusal(sequence),
              HasSubstr("does not cover the time of any depth image between 'camera' and 'world'"));
  sequence.change = nullptr;
  sequence.more = [](BagWriter& bag) {
    bag.add(test::RosTransform{"camera", "world", BagSequence::stampOf(0.0)});
  };
  EXPECT_THAT(refusal(sequence), HasSubstr("goes round in a circle above 'camera'"));
  sequence.more = [](BagWriter& bag) {
    bag.add(test::RosTransform{"island", "tree", BagSequence::stampOf(0.0)});
  };
  write("x.bag.toml", "fixed_frame = \"island\"\n");
  EXPECT_THAT(refusal(sequence), HasSubstr("does not connect 'camera' with the fixed frame 'island'"));
}

TEST_F(BagRefusal, ImagesThatAreNotAlikeOrDoNotFitAreRefusedByNumber) {
  BagSequence sequence;
  const auto error = [&](const std::function<void(RosImage&)>& change, int which = 4) {
    sequence.change = [&, which](int n, RosImage& image) {
      if (n == which) change(image);
    };
    return refusal(sequence);
  };
  EXPECT_THAT(error([](RosImage& image) { image.data.pop_back(); }),
              HasSubstr("image 4 of '/camera/depth/image_raw' holds 6431 bytes in rows of 134"));
  EXPECT_THAT(error([](RosImage& image) { image.step = 0xffffffff; }), HasSubstr("does not fit 64x48"));
  EXPECT_THAT(error([](RosImage& image) { image.step = 2, image.data.resize(2 * 48); }),
              HasSubstr("does not fit 64x48"));
  EXPECT_THAT(error([](RosImage& image) { image.height = 47, image.data.resize(134 * 47); }),
              HasSubstr("image 4 of '/camera/depth/image_raw' is 64x47 of 16UC1; the first is 64x48"));
  EXPECT_THAT(error([](RosImage& image) { image.encoding = "mono16"; }), HasSubstr("all must be alike"));
  EXPECT_THAT(error([](RosImage& image) { image.encoding = "16SC1\n"; }),
              HasSubstr("is of encoding '16SC1?'"));
  for (const int which : {0, 4}) {
    EXPECT_THAT(error([](RosImage& image) { image.big_endian = true; }, which), HasSubstr("is big-endian"));
    EXPECT_THAT(error([](RosImage& image) { image.width = 0; }, which), HasSubstr("is 0x48; allowed"));
    EXPECT_THAT(error([](RosImage& image) { image.width = 100000; }, which),
                HasSubstr("is 100000x48; allowed"));
  }
}

}  // namespace
}  // namespace vantage
