// Bad input, full disks and interruptions: one clear line, the right exit code, recorded steps kept.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace vantage::test {
namespace {

/// A data set of one flat wall: 4x4 poses, 32x24 pixels.
class TinyDataset {
 public:
  TinyDataset() {
    writeFile(folder_ / "camera-intrinsics.txt", "30 0 15.5\n0 30 11.5\n0 0 1\n");
    for (int n = 0; n < 3; ++n) {
      writeFile(folder_ / name(n, "pose.txt"), "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
      writeFile(folder_ / name(n, "depth.png"), png());
    }
  }
  static std::string name(int n, const std::string& what) {
    return "frame-00000" + std::to_string(n) + "." + what;
  }
  std::string path() const { return folder_.path().string(); }
  std::string file(int n, const std::string& what) const { return folder_ / name(n, what); }

 private:
  /// 32x24 pixels of 16 bits, every one 1000 (1 m), as an uncompressed PNG.
  static std::string png();
  TemporaryFolder folder_;
};

void bigEndian(std::string& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(value >> shift));
}

std::uint32_t crc32(const std::string& data) {
  std::uint32_t crc = 0xffffffffu;
  for (const char c : data) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

void chunk(std::string& out, const std::string& type, const std::string& data) {
  bigEndian(out, static_cast<std::uint32_t>(data.size()));
  out += type + data;
  bigEndian(out, crc32(type + data));
}

std::string TinyDataset::png() {
  constexpr int kWidth = 32, kHeight = 24, kMillimetres = 1000;
  std::string raw;
  for (int v = 0; v < kHeight; ++v) {
    raw.push_back(0);
    for (int u = 0; u < kWidth; ++u) {
      raw.push_back(static_cast<char>(kMillimetres >> 8));
      raw.push_back(static_cast<char>(kMillimetres & 255));
    }
  }
  std::uint32_t a = 1, b = 0;
  for (const char c : raw) {
    a = (a + static_cast<std::uint8_t>(c)) % 65521;
    b = (b + a) % 65521;
  }
  const auto size = static_cast<std::uint16_t>(raw.size());
  std::string zlib = "\x78\x01\x01";
  for (const int byte : {size & 255, size >> 8, ~size & 255, (~size >> 8) & 255})
    zlib.push_back(static_cast<char>(byte));
  zlib += raw;
  bigEndian(zlib, b << 16 | a);
  std::string header;
  bigEndian(header, kWidth);
  bigEndian(header, kHeight);
  header += std::string("\x10\x00\x00\x00\x00", 5);
  std::string out = "\x89PNG\r\n\x1a\n";
  chunk(out, "IHDR", header);
  chunk(out, "IDAT", zlib);
  chunk(out, "IEND", "");
  return out;
}

const std::vector<std::string> kSmallBounds = {
    "--bounds", "-0.5,-0.5,0.5,0.5,0.5,1.5", "--voxel-size", "0.05", "--truncation", "0.2"};

ProcessResult fuse(const TinyDataset& data, const std::string& output) {
  std::vector<std::string> words = {"fuse", data.path(), "-o", output};
  words.insert(words.end(), kSmallBounds.begin(), kSmallBounds.end());
  return vantage(words);
}

TEST(Faults, TheTinyDatasetItselfIsFine) {
  const TinyDataset data;
  const TemporaryFolder out;
  const ProcessResult result = fuse(data, out / "map.vti");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(out / "map.vti"));
}

TEST(Faults, MissingScene) {
  expectRefused(vantage({"explore", "nowhere/scene.toml"}), {"nowhere/scene.toml"});
}

TEST(Faults, BrokenSceneNamesFileAndLine) {
  const TemporaryFolder folder;
  writeFile(folder / "broken.toml", "name = \"x\"\n[[solid]\nkind = 3\n");
  expectRefused(vantage({"explore", folder / "broken.toml"}), {"broken.toml:2"});
  writeFile(folder / "kind.toml", "name = \"x\"\n[[solid]]\nkind = \"spere\"\nradius_m = 0.1\n");
  expectRefused(vantage({"explore", folder / "kind.toml"}), {"kind.toml:3", "spere", "sphere"});
  writeFile(folder / "key.toml", "name = \"x\"\n[[solid]]\nkind = \"sphere\"\nradius = 0.1\n");
  expectRefused(vantage({"explore", folder / "key.toml"}), {"key.toml:", "radius_m"});
  writeFile(folder / "mesh.toml", "name = \"x\"\n[[solid]]\nkind = \"mesh\"\nfile = \"gone.ply\"\n");
  expectRefused(vantage({"explore", folder / "mesh.toml"}), {"gone.ply"});
}

TEST(Faults, BrokenMesh) {
  const TemporaryFolder folder;
  writeFile(folder / "scene.toml", "name = \"x\"\n[[solid]]\nkind = \"mesh\"\nfile = \"m.obj\"\n");
  for (const std::string text :
       {"", "v 0 0\nf 1 2 3\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "\x00\x01\x02"}) {
    writeFile(folder / "m.obj", text);
    expectRefused(vantage({"explore", folder / "scene.toml"}), {"m.obj"});
  }
}

TEST(Faults, MissingFolderAndEmptyFolder) {
  const TemporaryFolder folder;
  expectRefused(vantage({"fuse", folder / "gone", "-o", folder / "m.vti"}), {"gone"});
  std::filesystem::create_directory(folder / "empty");
  expectRefused(vantage({"fuse", folder / "empty", "-o", folder / "m.vti"}), {"empty"});
}

TEST(Faults, BrokenPng) {
  const TinyDataset data;
  const TemporaryFolder out;
  const std::string whole = readFile(data.file(1, "depth.png"));
  for (const std::string& bytes :
       {std::string(), std::string("no picture"), whole.substr(0, whole.size() / 2)}) {
    writeFile(data.file(1, "depth.png"), bytes);
    expectRefused(fuse(data, out / "m.vti"), {"frame-000001.depth.png"});
  }
}

TEST(Faults, BrokenPose) {
  const TinyDataset data;
  const TemporaryFolder out;
  for (const char* text :
       {"1 0 0 0\n0 1 0\n", "1 0 0 0\n0 1 0 0\n0 0 1 x\n0 0 0 1\n", "",
        "2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "nan 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"}) {
    writeFile(data.file(2, "pose.txt"), text);
    expectRefused(fuse(data, out / "m.vti"), {"frame-000002.pose.txt"});
  }
  std::filesystem::remove(data.file(2, "pose.txt"));
  expectRefused(fuse(data, out / "m.vti"), {"frame-000002.pose.txt"});
}

TEST(Faults, BrokenIntrinsics) {
  const TinyDataset data;
  const TemporaryFolder out;
  const std::string path = data.path() + "/camera-intrinsics.txt";
  for (const char* text :
       {"", "1 2\n", "30 0 15.5\n0 thirty 11.5\n0 0 1\n", "-30 0 15.5\n0 30 11.5\n0 0 1\n"}) {
    writeFile(path, text);
    expectRefused(fuse(data, out / "m.vti"), {"camera-intrinsics.txt"});
  }
  std::filesystem::remove(path);
  expectRefused(fuse(data, out / "m.vti"), {"camera-intrinsics.txt"});
}

TEST(Faults, BrokenVti) {
  const TinyDataset data;
  const TemporaryFolder out;
  ASSERT_EQ(fuse(data, out / "map.vti").code, 0);
  const std::string whole = readFile(out / "map.vti");
  expectRefused(vantage({"contours", out / "gone.vti", "-o", "-"}), {"gone.vti"});
  for (const std::string& bytes :
       {std::string(), std::string("<VTKFile"), whole.substr(0, whole.size() / 2)}) {
    writeFile(out / "map.vti", bytes);
    expectRefused(vantage({"contours", out / "map.vti", "-o", "-"}), {"map.vti"});
  }
  expectRefused(vantage({"contours", out / "map.dat", "-o", "-"}), {"map.dat"});
}

TEST(Faults, BrokenCsv) {
  const TinyDataset data;
  const TemporaryFolder out;
  ASSERT_EQ(fuse(data, out / "map.vti").code, 0);
  const std::string header = "id,x_m,y_m,z_m,qx,qy,qz,qw\n";
  const auto gain = [&](const std::string& text) {
    writeFile(out / "views.csv", text);
    return vantage({"gain", out / "map.vti", out / "views.csv", "-o", out / "gains.csv"});
  };
  EXPECT_EQ(gain(header + "0,0,0,0,0,0,0,1\n").code, 0);
  expectRefused(gain(""), {"views.csv"});
  expectRefused(gain("id,x_m,y_m\n0,0,0\n"), {"views.csv:1", "z_m"});
  expectRefused(gain(header + "0,0,0,zero,0,0,0,1\n"), {"views.csv:2", "zero"});
  expectRefused(gain(header + "0,0,0,0,0,0,0,1\n1,0,0,0,0,0\n"), {"views.csv:3"});
  expectRefused(gain(header + "0,0,0,0,0,0,0,1.1\n"), {"views.csv:2", "length 1.1"});
  expectRefused(vantage({"gain", out / "map.vti", out / "none.csv", "-o", out / "gains.csv"}), {"none.csv"});
}

TEST(Faults, BrokenRunFile) {
  const TemporaryFolder folder;
  expectRefused(vantage({"info", folder / "gone.vantage"}), {"gone.vantage"});
  for (const std::string& bytes : {std::string(), std::string("not a run"), std::string(5000, 'x')}) {
    writeFile(folder / "bad.vantage", bytes);
    expectRefused(vantage({"info", folder / "bad.vantage"}), {"bad.vantage"});
    expectRefused(vantage({"snapshot", folder / "bad.vantage", "-o", folder / "x.png"}), {"bad.vantage"});
  }
}

TEST(Faults, DepthWithoutOneValidPixelIsNoCrash) {
  const TemporaryFolder folder;
  // Nothing in the room but a wall beyond the range: every pixel is invalid.
  writeFile(folder / "void.toml",
            "name = \"void\"\n[[solid]]\nkind = \"box\"\nposition_m = [0, 50, 0]\nsize_m = [1, 1, 1]\n"
            "[volume]\norigin_m = [-0.5, -1.1, 0.0]\nvoxel_size_m = 0.02\nsize = [50, 60, 50]\n"
            "[fusion]\ntruncation_m = 0.06\n");
  const ProcessResult result =
      vantage({"explore", folder / "void.toml", "-o", folder / "void.vantage", "--steps", "2", "--json",
               folder / "void.json", "--snapshots", folder / "pictures"});
  EXPECT_EQ(result.code, 0) << result.err;
  const auto run = nlohmann::json::parse(readFile(folder / "void.json"));
  EXPECT_EQ(run["stop_reason"], "finished");
  EXPECT_EQ(run["steps"][0]["status"], "none");
  EXPECT_TRUE(run["steps"][0]["position_m"].is_null());
}

TEST(Faults, AVolumeThatDoesNotFitInMemoryIsRefused) {
  const TemporaryFolder folder;
  // More voxels than can be numbered is a bad value; fewer that the machine has no room for is a failure.
  expectRefused(
      vantage({"explore", "box", "-o", folder / "x.vantage", "--set", "volume.size=[8000,8000,8000]"}),
      {"volume.size"});
  ProcessOptions small;
  small.memory_limit = std::size_t{4} << 30;
  expectRefused(
      vantage({"explore", "box", "-o", folder / "x.vantage", "--set", "volume.size=[1100,1100,1100]"}, small),
      {"1100 x 1100 x 1100 voxels", "does not fit in memory"}, 1);
}

TEST(Faults, AFullDiskKeepsWhatWasRecorded) {
  const TemporaryFolder folder;
  // How large the file is after one step tells how much room lets the second one fail.
  ASSERT_EQ(vantage({"explore", "box", "--steps", "1", "-o", folder / "one.vantage"}).code, 0);
  ProcessOptions full;
  full.file_size_limit = std::filesystem::file_size(folder / "one.vantage") * 5 / 4;
  const ProcessResult result =
      vantage({"explore", "box", "--steps", "4", "-o", folder / "full.vantage"}, full);
  expectRefused(result, {"full.vantage"}, 1);
  const ProcessResult info = vantage({"info", folder / "full.vantage", "--json", "-"});
  ASSERT_EQ(info.code, 0) << info.err;
  const auto facts = nlohmann::json::parse(info.out);
  EXPECT_GE(facts["steps"].get<int>(), 1);
  EXPECT_LT(facts["steps"].get<int>(), 4);
}

TEST(Faults, UnwritableOutputsAreNamed) {
  const TinyDataset data;
  expectRefused(fuse(data, "/nonexistent/map.vti"), {"/nonexistent/map.vti"});
  const TemporaryFolder folder;
  ASSERT_EQ(fuse(data, folder / "map.vti").code, 0);
  expectRefused(vantage({"contours", folder / "map.vti", "-o", "/nonexistent/v.csv"}),
                {"/nonexistent/v.csv"});
  expectRefused(vantage({"contours", folder / "map.vti", "-o", "/dev/full"}), {"/dev/full"}, 1);
  expectRefused(vantage({"explore", "box", "-o", "/nonexistent/x.vantage"}), {"/nonexistent/x.vantage"});
}

TEST(Faults, InterruptingKeepsTheFinishedSteps) {
  const TemporaryFolder folder;
  ProcessOptions interrupt;
  interrupt.interrupt_after_s = 6.0;
  const ProcessResult result =
      vantage({"explore", "box", "--steps", "500", "-o", folder / "cut.vantage", "--set", "gain.threshold=0"},
              interrupt);
  EXPECT_EQ(result.code, 1) << result.err;
  EXPECT_NE(result.err.find("interrupted"), std::string::npos) << result.err;
  const ProcessResult info = vantage({"info", folder / "cut.vantage", "--json", "-"});
  ASSERT_EQ(info.code, 0) << info.err;
  EXPECT_EQ(nlohmann::json::parse(info.out)["stop_reason"], "cancelled");
  EXPECT_GE(nlohmann::json::parse(info.out)["steps"].get<int>(), 1);
  EXPECT_FALSE(std::filesystem::exists(folder / "cut.vantage-wal"));
}

TEST(Faults, SnapshotWithoutADriverSaysWhatHelps) {
  const TemporaryFolder folder;
  ASSERT_EQ(vantage({"explore", "box", "--steps", "1", "-o", folder / "run.vantage"}).code, 0);
  ProcessOptions none;
  none.environment = {{"__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent"}};
  expectRefused(vantage({"snapshot", folder / "run.vantage", "-o", folder / "pictures"}, none),
                {"libegl-mesa0"}, 3);
}

}  // namespace
}  // namespace vantage::test
