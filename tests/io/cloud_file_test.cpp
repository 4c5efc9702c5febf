#include "io/cloud_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/io/data_support.h"

namespace vantage {
namespace {

using testing::HasSubstr;

SurfaceCloud smallMesh() {
  SurfaceCloud cloud;
  cloud.points = {{0, 0, 0}, {0.1f, 0, 0}, {0, 1.0f / 3.0f, 0}, {5, 6, 7}};
  cloud.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0.6f, 0.8f}, {1, 0, 0}};
  cloud.triangles = {{0, 1, 2}, {2, 1, 3}};
  return cloud;
}

class CloudFile : public FolderTest {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string error(const std::string& name, const std::string& text) {
    write(name, text);
    return errorOf([&] { readCloud(path(name)); });
  }
};

std::string pcd(const std::string& fields, const std::string& count, const std::string& data) {
  return "# .PCD v0.7\nVERSION 0.7\n" + fields + "WIDTH " + count +
         "\nHEIGHT 1\nVIEWPOINT 0 0 9 1 0 0 0\nPOINTS " + count + "\nDATA " + data;
}
const std::string kXyz = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";

TEST_F(CloudFile, PcdAndPlyReadBackAsTheyWereWritten) {
  const SurfaceCloud cloud = smallMesh();
  for (const std::string name : {"c.pcd", "c.ply"}) {
    writeCloud(path(name), cloud);
    const SurfaceCloud read = readCloud(path(name));
    EXPECT_EQ(read.points, cloud.points) << name;
    ASSERT_EQ(read.normals.size(), cloud.normals.size());
    for (std::size_t i = 0; i < read.normals.size(); ++i)
      EXPECT_TRUE(read.normals[i].isApprox(cloud.normals[i], 1e-6f));
  }
  EXPECT_EQ(readCloud(path("c.ply")).triangles, cloud.triangles);
  EXPECT_TRUE(readCloud(path("c.pcd")).triangles.empty());
}

TEST_F(CloudFile, LabelsStandBesideThePoints) {
  writeLabelledCloud(path("l.pcd"), smallMesh(), {3, 0, 1, 2});
  EXPECT_THAT(
      read("l.pcd"),
      HasSubstr("FIELDS x y z normal_x normal_y normal_z label\nSIZE 4 4 4 4 4 4 4\nTYPE F F F F F F U\n"));
  EXPECT_EQ(readCloud(path("l.pcd")).points, smallMesh().points);
  EXPECT_THROW(writeLabelledCloud(path("l.pcd"), smallMesh(), {1}), std::invalid_argument);
}

TEST_F(CloudFile, PointsThatAreNotFiniteAreLeftOut) {
  write("n.pcd", pcd(kXyz, "5", "ascii\n0 0 0\nnan nan nan\n1 0 0\n0 1 0\n1 1 inf\n"));
  const SurfaceCloud cloud = readCloud(path("n.pcd"));
  EXPECT_EQ(cloud.points.size(), 3u);
  for (const Eigen::Vector3f& normal : cloud.normals)
    EXPECT_NEAR(normal.z(), 1.0f, 1e-5f);  // toward the sensor at z = 9
}

TEST_F(CloudFile, EstimatedNormalsOfASphereAreRadial) {
  std::vector<Eigen::Vector3f> points;
  std::mt19937 engine(5);
  std::normal_distribution<float> gauss;
  for (int i = 0; i < 5000; ++i)
    points.push_back(Eigen::Vector3f(gauss(engine), gauss(engine), gauss(engine)).normalized());
  const auto normals = estimateNormals(points, Eigen::Vector3f(0, 0, 0));
  ASSERT_EQ(normals.size(), points.size());
  double worst = 1.0;
  for (std::size_t i = 0; i < points.size(); ++i) worst = std::min<double>(worst, -normals[i].dot(points[i]));
  EXPECT_GT(worst, std::cos(0.1));  // inward, toward the sensor in the middle
  EXPECT_TRUE(estimateNormals({}, Eigen::Vector3f::Zero()).empty());
}

TEST_F(CloudFile, BrokenFilesAreRefusedByFileAndLine) {
  EXPECT_THAT(errorOf([&] { readCloud(path("no.pcd")); }), HasSubstr("no.pcd: cannot be read"));
  EXPECT_THAT(errorOf([&] { readCloud(path("c.xyz")); }), HasSubstr("allowed: .pcd | .ply"));
  EXPECT_THAT(error("e.pcd", ""), HasSubstr("is not a PCD file"));
  EXPECT_THAT(error("e.pcd", "hello\n"), HasSubstr("e.pcd:1: is no PCD header line"));
  EXPECT_THAT(error("e.pcd", pcd("FIELDS x y\nSIZE 4 4\nTYPE F F\n", "1", "ascii\n1 2\n")),
              HasSubstr("has no fields x, y, z"));
  EXPECT_THAT(error("e.pcd", pcd("FIELDS x y z\nSIZE 4 4 4\nTYPE U F F\n", "1", "ascii\n1 2 3\n")),
              HasSubstr("the field x is not one float"));
  EXPECT_THAT(error("e.pcd", pcd("FIELDS x y z\nSIZE 3 4 4\n", "1", "ascii\n1 2 3\n")),
              HasSubstr("SIZE 3 is not usable"));
  EXPECT_THAT(error("e.pcd", pcd(kXyz, "2", "ascii\n1 2 3\n")),
              HasSubstr("the file ends after 1 of 2 points"));
  EXPECT_THAT(error("e.pcd", pcd(kXyz, "1", "ascii\n1 2 three\n")),
              HasSubstr("e.pcd:12: three is no number"));
  EXPECT_THAT(error("e.pcd", pcd(kXyz, "2", "binary\n123456789")), HasSubstr("the file ends too early"));
  EXPECT_THAT(error("e.pcd", pcd(kXyz, "2", "morse\n")), HasSubstr("DATA is 'morse'"));
  EXPECT_THAT(error("e.pcd", pcd(kXyz, "4000000000", "binary\n1")), HasSubstr("more than it can hold"));
  EXPECT_THAT(error("e.pcd", pcd(kXyz, "1", "ascii\nnan nan nan\n")), HasSubstr("holds no finite point"));
  EXPECT_THAT(error("e.ply", "plyx"), HasSubstr("e.ply"));
}

TEST_F(CloudFile, DamagedFilesAreRefusedOrReadNeverWorse) {
  VANTAGE_RECORDED(recorded, "pcl/milk.pcd");
  std::ifstream file(recorded, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  for (std::size_t length = 0; length < whole.size() / 2; length += whole.size() / 20)
    EXPECT_NE(error("cut.pcd", whole.substr(0, length)), "no InputError");
  std::mt19937 engine(11);
  for (int i = 0; i < 40; ++i) {
    std::string damaged = whole;
    damaged[engine() % (i < 20 ? 400 : damaged.size())] ^= 0x21;
    try {
      readCloud(write("damaged.pcd", damaged).string());
    } catch (const InputError&) {
    }
  }
}

TEST_F(CloudFile, RecordedCompressedCloudsHaveTheirFinitePoints) {
  VANTAGE_RECORDED(folder, "pcl");
  EXPECT_EQ(readCloud((folder / "milk.pcd").string()).points.size(), 12575u);
  EXPECT_EQ(readCloud((folder / "table_scene_mug_stereo_textured.pcd").string()).points.size(), 209280u);
}

}  // namespace
}  // namespace vantage
