#include "io/volume_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <sstream>

#include "tests/io/data_support.h"

namespace vantage {
namespace {

using testing::HasSubstr;

TsdfVolume randomVolume() {
  TsdfVolume volume(GridGeometry{{-1.25, 0.5, 1.0 / 3.0}, 3.0 / 512.0, {19, 7, 11}});
  std::mt19937 engine(3);
  std::uniform_int_distribution<int> value(-32767, 32767), weight(0, 60000);
  for (TsdfVoxel& voxel : volume.voxels()) {
    voxel.value = static_cast<std::int16_t>(value(engine));
    voxel.weight = static_cast<std::uint16_t>(weight(engine) % 3 == 0 ? 0 : weight(engine));
  }
  return volume;
}

/// ASCII image data of 2x2x2 samples.
std::string asciiFile(const std::string& tsdf, const std::string& weight,
                      const std::string& spacing = "0.5 0.5 0.5", bool cells = false,
                      const std::string& extent = "") {
  const std::string whole = !extent.empty() ? extent : cells ? "0 2 0 2 0 2" : "0 1 0 1 0 1";
  const std::string kind = cells ? "CellData" : "PointData";
  std::ostringstream text;
  text
      << "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      << "<ImageData WholeExtent=\"" << whole << "\" Origin=\"1 2 3\" Spacing=\"" << spacing
      << "\">\n<Piece Extent=\"" << whole << "\">\n<" << kind << ">\n";
  if (!tsdf.empty())
    text << "<DataArray type=\"Float32\" Name=\"tsdf\" format=\"ascii\">" << tsdf << "</DataArray>\n";
  if (!weight.empty())
    text << "<DataArray type=\"Float32\" Name=\"weight\" format=\"ascii\">" << weight << "</DataArray>\n";
  text << "</" << kind << ">\n</Piece>\n</ImageData>\n</VTKFile>\n";
  return text.str();
}

const char* const kValues = "-1 -0.5 0 0.5 1 1e-9 -1e-9 0.25";
const char* const kWeights = "0 1 2 3 4 5 6 0.25";

class VolumeFile : public FolderTest {
 protected:
  std::string readError(const std::string& text) {
    const auto path = write("v.vti", text);
    return errorOf([&] { readVolume(path, warnings_); });
  }
  std::vector<std::string> warnings_;
};

TEST_F(VolumeFile, WritingAndReadingGivesAnEqualVolume) {
  const TsdfVolume volume = randomVolume();
  writeVolume(folder_ / "v.vti", volume);
  const TsdfVolume read = readVolume(folder_ / "v.vti", warnings_);
  EXPECT_EQ(read.geometry(), volume.geometry());
  EXPECT_TRUE(
      std::equal(read.voxels().begin(), read.voxels().end(), volume.voxels().begin(), volume.voxels().end()));
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(VolumeFile, AsciiPointDataIsRead) {
  const TsdfVolume read = readVolume(write("v.vti", asciiFile(kValues, kWeights)), warnings_);
  EXPECT_EQ(read.geometry(), (GridGeometry{{1, 2, 3}, 0.5, {2, 2, 2}}));
  EXPECT_EQ(read.at(0, 0, 0).value, -32767);
  EXPECT_EQ(read.at(0, 0, 0).state(), VoxelState::Unknown);
  EXPECT_EQ(read.at(1, 0, 0).state(), VoxelState::Occupied);
  EXPECT_EQ(read.at(0, 1, 0).state(), VoxelState::Occupied);  // 0
  EXPECT_EQ(read.at(1, 0, 1).state(), VoxelState::Free);      // 1e-9 stays empty
  EXPECT_EQ(read.at(0, 1, 1).state(), VoxelState::Occupied);  // -1e-9
  EXPECT_EQ(read.at(1, 1, 1).weight, 1);                      // 0.25 stays known
}

TEST_F(VolumeFile, CellDataLiesHalfASpacingFromTheOrigin) {
  const TsdfVolume read =
      readVolume(write("v.vti", asciiFile(kValues, kWeights, "0.5 0.5 0.5", true)), warnings_);
  EXPECT_EQ(read.geometry(), (GridGeometry{{1.25, 2.25, 3.25}, 0.5, {2, 2, 2}}));
  EXPECT_EQ(read.at(1, 1, 0).value, 16384);
}

TEST_F(VolumeFile, ExtentsMayStartAnywhere) {
  const TsdfVolume read = readVolume(
      write("v.vti", asciiFile(kValues, kWeights, "0.5 0.5 0.5", false, "2 3 -4 -3 0 1")), warnings_);
  EXPECT_TRUE(read.geometry().origin_m.isApprox(Eigen::Vector3d(2, 0, 3)));
}

TEST_F(VolumeFile, NotANumberMeansUnknownWithAWarning) {
  const TsdfVolume read =
      readVolume(write("v.vti", asciiFile("nan 2 0 0.5 1 1 1 1", "9 9 9 9 -1 9 9 9")), warnings_);
  EXPECT_EQ(read.at(0, 0, 0).state(), VoxelState::Unknown);
  EXPECT_EQ(read.at(1, 0, 0).value, 32767);
  EXPECT_EQ(read.at(0, 0, 1).state(), VoxelState::Unknown);
  ASSERT_EQ(warnings_.size(), 2u);
  EXPECT_THAT(warnings_[0], HasSubstr("1 voxels are not a number"));
  EXPECT_THAT(warnings_[1], HasSubstr("2 voxels lie beyond"));
}

TEST_F(VolumeFile, FilesThatAreNoTsdfAreRefusedInOneLine) {
  testing::internal::CaptureStderr();
  EXPECT_THAT(errorOf([&] { readVolume(folder_ / "no.vti", warnings_); }),
              HasSubstr("no.vti: cannot be read"));
  EXPECT_THAT(errorOf([&] { readVolume(folder_, warnings_); }), HasSubstr("is a folder"));
  EXPECT_THAT(readError(""), HasSubstr("is not VTK XML image data"));
  EXPECT_THAT(readError("<VTKFile type=\"PolyData\"></VTKFile>"), HasSubstr("is not VTK XML image data"));
  EXPECT_THAT(readError(asciiFile(kValues, "")), HasSubstr("has no array 'weight'"));
  EXPECT_THAT(readError(asciiFile("", kWeights)), HasSubstr("has no array 'tsdf'"));
  EXPECT_THAT(readError(asciiFile(kValues, kWeights, "0.5 0.5 0.4")), HasSubstr("voxels are not cubes"));
  EXPECT_THAT(readError(asciiFile(kValues, kWeights, "0 0 0")), HasSubstr("the spacing is 0"));
  EXPECT_THAT(readError(asciiFile(kValues, kWeights, "-1 -1 -1")), HasSubstr("v.vti: "));
  EXPECT_THAT(readError(asciiFile(kValues, kWeights, "1 1 1", false, "0 0 0 1 0 1")),
              HasSubstr("1 voxels along an axis"));
  const std::string whole = asciiFile(kValues, kWeights);
  EXPECT_THAT(readError(whole.substr(0, whole.size() / 2)), HasSubstr("v.vti: "));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(VolumeFile, SizesTheFileCannotHoldAreRefusedBeforeAllocating) {
  EXPECT_THAT(readError(asciiFile(kValues, kWeights, "1 1 1", false, "0 99999 0 99999 0 99999")),
              HasSubstr("more than the file can hold"));
  EXPECT_THAT(readError(asciiFile(kValues, kWeights, "1 1 1", false, "0 2147483647 0 1 0 1")),
              HasSubstr("voxels along an axis"));
  std::string many = asciiFile(kValues, kWeights);
  many.replace(many.find("Name=\"tsdf\""), 0, "NumberOfComponents=\"1000000000\" ");
  EXPECT_THAT(readError(many), HasSubstr("components"));
}

TEST_F(VolumeFile, DamagedFilesAreRefusedOrReadNeverWorse) {
  writeVolume(folder_ / "w.vti", randomVolume());
  const std::string whole = read("w.vti");
  testing::internal::CaptureStderr();
  int refused = 0;
  for (std::size_t length = 0; length < whole.size(); length += whole.size() / 40)
    refused += readError(whole.substr(0, length)) != "no InputError";
  EXPECT_GE(refused, 38);
  for (std::size_t i = 0; i < whole.size(); i += whole.size() / 60) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x15);
    readError(damaged);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(VolumeFile, PlacesThatCannotBeWrittenAreNamed) {
  EXPECT_THAT(errorOf([&] { writeVolume(folder_ / "no/v.vti", randomVolume()); }),
              HasSubstr("v.vti: cannot be created"));
  EXPECT_THROW(writeVolume(folder_ / "v.vti", TsdfVolume{}), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
