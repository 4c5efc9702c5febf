#include "io/table_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>
#include <sstream>

#include "io/csv_table.h"
#include "tests/io/data_support.h"

namespace vantage {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class TableFile : public FolderTest {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string viewError(const std::string& text) {
    write("v.csv", text);
    return errorOf([&] { readViews(path("v.csv")); });
  }
};

TEST(CsvTable, QuotesWordsThatWouldBreakARow) {
  CsvTable table("word,number,maybe,none");
  table.cell("a,b").cell(0.1).cell(std::optional(7u)).cell(std::optional<double>()).endRow();
  table.cell("say \"yes\"").cell(1.0f / 3.0f).cell(-3).cell("plain").endRow();
  EXPECT_EQ(table.text(),
            "word,number,maybe,none\n\"a,b\",0.1,7,\n\"say \"\"yes\"\"\",0.33333334,-3,plain\n");
}

const std::string kHeader = "id,x_m,y_m,z_m,qx,qy,qz,qw\n";

TEST_F(TableFile, ViewsReadBackAsTheyWereWritten) {
  const Pose pose = makePose({0.1, 1.0 / 3.0, -2e-7}, Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5));
  writeViews(path("v.csv"), {{7, pose, std::nullopt}, {4000000000u, Pose::Identity(), 3u}});
  EXPECT_THAT(read("v.csv"),
              StartsWith("id,x_m,y_m,z_m,qx,qy,qz,qw,group\n7,0.1,0.3333333333333333,-2e-07,"));
  const auto views = readViews(path("v.csv"));
  ASSERT_EQ(views.size(), 2u);
  EXPECT_EQ(views[0].id, 7u);
  EXPECT_EQ(views[0].T_world_camera.translation(), pose.translation());
  EXPECT_TRUE(views[0].T_world_camera.isApprox(pose, 1e-14));
  EXPECT_FALSE(views[0].group.has_value());
  EXPECT_EQ(views[1].id, 4000000000u);
  EXPECT_EQ(views[1].group, 3u);
}

TEST_F(TableFile, TheGroupColumnIsThereOnlyIfSomeViewHasOne) {
  writeViews(path("v.csv"), {{1, Pose::Identity(), std::nullopt}});
  EXPECT_EQ(read("v.csv"), kHeader + "1,0,0,0,0,0,0,1\n");
}

TEST_F(TableFile, ColumnsMayStandInAnyOrderAndBlankLinesAndSpacesDoNotMatter) {
  write("v.csv", "\xef\xbb\xbfqw,qz,qy,qx,z_m,y_m,x_m,id,note\r\n1,0,0,0, 3 ,2,1,9,hello\r\n\r\n");
  const auto views = readViews(path("v.csv"));
  ASSERT_EQ(views.size(), 1u);
  EXPECT_EQ(views[0].T_world_camera.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(views[0].id, 9u);
}

TEST_F(TableFile, MistakesInViewTablesAreRefusedByLine) {
  EXPECT_THAT(viewError(""), HasSubstr("v.csv: is empty"));
  EXPECT_THAT(viewError("id,x_m\n1,2\n"), HasSubstr("v.csv:1: the header has no column 'y_m'"));
  EXPECT_THAT(viewError(kHeader + "1,0,0,0,0,0,0,1\n2,0,0,0,0,0,0,0.9\n"),
              HasSubstr("v.csv:3: the quaternion has length 0.9"));
  EXPECT_EQ(viewError(kHeader + "1,0,0,0,0,0,0,1.0009\n"), "no InputError");
  EXPECT_THAT(viewError(kHeader + "1,0,0,0,0,0,0,1.0011\n"), HasSubstr("allowed: 1 within 0.001"));
  EXPECT_THAT(viewError(kHeader + "1,0,0,0,0,0,0\n"), HasSubstr("v.csv:2: 7 cells; the header has 8"));
  EXPECT_THAT(viewError(kHeader + "1,a,0,0,0,0,0,1\n"),
              HasSubstr("v.csv:2: x_m = 'a' is not a finite number"));
  EXPECT_THAT(viewError(kHeader + "1,nan,0,0,0,0,0,1\n"), HasSubstr("not a finite number"));
  EXPECT_THAT(viewError(kHeader + "-1,0,0,0,0,0,0,1\n"), HasSubstr("id = '-1' is not a whole number"));
  EXPECT_THAT(viewError(kHeader + "1.5,0,0,0,0,0,0,1\n"), HasSubstr("is not a whole number"));
  EXPECT_THAT(errorOf([&] { readViews(path("no.csv")); }), HasSubstr("no.csv: cannot be read"));
}

TEST_F(TableFile, TheOtherTablesHaveTheirColumns) {
  const GridGeometry geometry{{1, 2, 3}, 0.5, {9, 9, 9}};
  ContourVoxel voxel;
  voxel.voxel = {1, 2, 3};
  voxel.raw_normal = voxel.normal = {0, 0, 1};
  voxel.group = 4;
  writeContourVoxels(path("c.csv"), geometry, {voxel});
  EXPECT_EQ(read("c.csv"), "i,j,k,x_m,y_m,z_m,nx,ny,nz,group\n1,2,3,1.5,3,4.5,0,0,1,4\n");
  writeContourPoints(path("p.csv"), {{{1, 2, 3}, {0, 1, 0}, 5}});
  EXPECT_EQ(read("p.csv"), "group,x_m,y_m,z_m,nx,ny,nz,voxels\n0,1,2,3,0,1,0,5\n");
  writeGains(path("g.csv"), {{3, 10, 20, 30, 40, "position"}, {4, 1, 2, 3, 10000000000ull, ""}});
  EXPECT_EQ(read("g.csv"),
            "id,unknown,occupied,rays,visited,reject\n3,10,20,30,40,position\n4,1,2,3,10000000000,\n");
  Segment segment;
  segment.label = 2;
  segment.points = 11;
  segment.saliency = 0.25;
  segment.isolation = 0.5;
  segment.roundness = 0.5;
  segment.extent_m = {3, 2, 1};
  segment.center_m = {7, 8, 9};
  segment.radius_m = 0.1;
  writeSegments(path("s.csv"), {segment});
  EXPECT_EQ(read("s.csv"),
            "segment,points,saliency,isolation,roundness,d1_m,d2_m,d3_m,cx_m,cy_m,cz_m,radius_m\n"
            "2,11,0.25,0.5,0.5,3,2,1,7,8,9,0.1\n");
}

TEST_F(TableFile, ADashIsStandardOutputAndInput) {
  testing::internal::CaptureStdout();
  writeViews("-", {{1, Pose::Identity(), std::nullopt}});
  EXPECT_EQ(testing::internal::GetCapturedStdout(), kHeader + "1,0,0,0,0,0,0,1\n");
  std::istringstream input(kHeader + "5,0,0,0,0,0,0,1\n6,0,0,0,0,0,0,2\n");
  std::streambuf* before = std::cin.rdbuf(input.rdbuf());
  EXPECT_THAT(errorOf([] { readViews("-"); }), HasSubstr("standard input:3: the quaternion"));
  std::cin.rdbuf(before);
}

TEST_F(TableFile, PlacesThatCannotBeWrittenAreNamed) {
  EXPECT_THROW(writeGains(path("no/g.csv"), {}), std::runtime_error);
}

}  // namespace
}  // namespace vantage
