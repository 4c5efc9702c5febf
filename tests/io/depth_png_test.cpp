#include "io/depth_png.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/io/data_support.h"

namespace vantage {
namespace {

using testing::HasSubstr;

class DepthPng : public FolderTest {
 protected:
  DepthImage random(int width, int height) {
    std::mt19937 engine(7);
    std::uniform_int_distribution<int> millimetres(0, 65534);
    DepthImage image(width, height);
    for (float& d : image.depth_m) {
      const int mm = millimetres(engine);
      if (mm > 0) d = static_cast<float>(mm * 0.001);
    }
    return image;
  }
};

TEST_F(DepthPng, WritingAndReadingKeepsEveryMillimetre) {
  const DepthImage image = random(37, 23);
  writeDepthPng(folder_ / "d.png", image);
  const DepthImage read = readDepthPng(folder_ / "d.png");
  EXPECT_EQ(depthPngSize(folder_ / "d.png"), (ImageSize{37, 23}));
  ASSERT_EQ(read.depth_m.size(), image.depth_m.size());
  for (std::size_t i = 0; i < image.depth_m.size(); ++i) {
    if (DepthImage::valid(image.depth_m[i]))
      EXPECT_EQ(read.depth_m[i], image.depth_m[i]);
    else
      EXPECT_TRUE(std::isnan(read.depth_m[i]));
  }
}

TEST_F(DepthPng, InvalidAndTooLargeDepthsBecomeInvalid) {
  DepthImage image(3, 1);
  image.depth_m = {-1.0f, 70.0f, 65.535f};
  writeDepthPng(folder_ / "d.png", image);
  for (const float d : readDepthPng(folder_ / "d.png", {0.001, {}}).depth_m) EXPECT_TRUE(std::isnan(d));
}

TEST_F(DepthPng, UnitAndInvalidCountsAreThoseOfTheFormat) {
  DepthImage image(2, 1);
  image.depth_m = {1.0f, 2.0f};
  writeDepthPng(folder_ / "d.png", image);
  const DepthImage read = readDepthPng(folder_ / "d.png", {0.0002, {2000}});
  EXPECT_FLOAT_EQ(read.at(0, 0), 0.2f);
  EXPECT_TRUE(std::isnan(read.at(1, 0)));
}

TEST_F(DepthPng, BrokenFilesAreRefusedAndNothingIsPrinted) {
  writeDepthPng(folder_ / "d.png", random(64, 64));
  const std::string whole = read("d.png");
  testing::internal::CaptureStderr();
  EXPECT_THAT(errorOf([&] { readDepthPng(folder_ / "no.png"); }), HasSubstr("no.png: cannot be read"));
  EXPECT_THAT(errorOf([&] { readDepthPng(folder_); }), HasSubstr("is a folder"));
  EXPECT_THAT(errorOf([&] { readDepthPng(write("e.png", "")); }), HasSubstr("e.png: is not a PNG image"));
  for (const std::size_t length :
       {std::size_t{8}, std::size_t{20}, std::size_t{40}, whole.size() / 2, whole.size() - 20})
    EXPECT_THAT(errorOf([&] { readDepthPng(write("cut.png", whole.substr(0, length))); }),
                HasSubstr("cut.png: damaged PNG"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(DepthPng, FlippedBytesNeverDoMoreThanBeRefused) {
  writeDepthPng(folder_ / "d.png", random(16, 16));
  const std::string whole = read("d.png");
  int refused = 0;
  for (std::size_t i = 0; i < whole.size(); i += 3) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x5a);
    const std::string message = errorOf([&] { readDepthPng(write("f.png", damaged)); });
    if (message != "no InputError") ++refused;
  }
  EXPECT_GT(refused, 50);
}

TEST_F(DepthPng, HugeImagesAreRefusedBeforeTheyAreDecoded) {
  writeDepthPng(folder_ / "d.png", DepthImage(9000, 1));
  EXPECT_THAT(errorOf([&] { depthPngSize(folder_ / "d.png"); }), HasSubstr("damaged PNG image"));
}

TEST_F(DepthPng, BytesAreNoDepth) {
  writeBytePng(folder_ / "mask.png", 3, 2, {0, 1, 2, 3, 4, 0});
  EXPECT_THAT(errorOf([&] { readDepthPng(folder_ / "mask.png"); }),
              HasSubstr("8 bit; a 16-bit grey PNG is wanted"));
  EXPECT_THROW(writeBytePng(folder_ / "mask.png", 3, 2, {0}), std::invalid_argument);
  EXPECT_THAT(errorOf([&] { writeBytePng(folder_ / "no/mask.png", 1, 1, {0}); }),
              HasSubstr("cannot be written"));
}

}  // namespace
}  // namespace vantage
