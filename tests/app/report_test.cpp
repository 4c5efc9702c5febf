#include "viewer/app/experiments/report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/tiny_experiments.h"
#include "viewer/app/experiments/evaluation_time.h"

namespace vantage::experiments {
namespace {

std::string defaultOf(const std::vector<DefaultUsed>& defaults, const std::string& name) {
  for (const DefaultUsed& used : defaults)
    if (used.name == name) return used.value;
  return "";
}

TEST(Defaults, AreThoseThatWereUsed) {
  Settings settings;
  settings.exploration.octree.known_scene = true;
  settings.exploration.hierarchical.generator = CandidateGenerator::Workspace;
  settings.exploration.hierarchical.workspace_views = 77;
  EXPECT_EQ(defaultOf(defaultsUsed(settings, "A3", true), "around the object's box"),
            "free; boxes of the scene (table, walls, furniture) known");
  EXPECT_EQ(defaultOf(defaultsUsed(settings, "A3", false), "around the object's box"),
            "free; free where a recorded camera has been");
  EXPECT_EQ(defaultOf(defaultsUsed(settings, "A3", true), "candidates"), "77 drawn in the workspace");
  settings.exploration.recorded_candidates = true;
  EXPECT_EQ(defaultOf(defaultsUsed(settings, "A3", false), "candidates"),
            "77 drawn in the workspace, and the recorded poses that are left");
  settings.exploration.octree.outside = VoxelState::Unknown;
  settings.exploration.octree.known_scene = false;
  settings.exploration.hierarchical.min_overlap = 0.2;
  EXPECT_EQ(defaultOf(defaultsUsed(settings, "A3", true), "around the object's box"),
            "unknown; nothing of the scene known");
  EXPECT_TRUE(defaultOf(defaultsUsed(settings, "A3", true), "least known surface h_oc").starts_with("20 %"));
  ExperimentOptions options = tinyOptions();
  options.sizes_m = {0.1, 0.3};
  EXPECT_EQ(sizesUsed(tableObjects(options), "A1").value, "0.1 m, 0.3 m");
}

TEST(EvaluationTime, IsTheMedian) {
  EXPECT_EQ(median({3, 1, 2}), 2.0);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_EQ(median({}), 0.0);
}

Report sampleReport() {
  Report report;
  report.title = "a <b> & \"c\"";
  report.setup = {"threads used: 2"};
  report.tables = {
      {"t", "Title", {"word", "number"}, {{"x, \"y\"", Cell::number(1.25, 1, " %")}, {"z", "-"}}}};
  report.claims = {{"A1 (1)", "claim", "paper", "ours", Verdict::Missed, "why"}};
  report.lines = {{"curve", "scan", "voxels", {{"run", {3, 2, 1}}}}};
  report.bars = {{"bars", " %", {{"run", 4.0}, {"other", 12.0}}, 10.0}};
  report.defaults = {{"w", "1", "D-A17", "A1"}};
  report.notes = {"note"};
  return report;
}

TEST(ReportFiles, ListEqualDefaultsOnceForAllThatUsedThem) {
  Report report, other;
  report.defaults = {{"w", "1", "D-A17", "A1"}};
  other.defaults = {{"w", "1", "D-A17", "A2"}, {"w", "2", "D-A17", "A2"}};
  report.append(std::move(other));
  ASSERT_EQ(report.defaults.size(), 2u);
  EXPECT_EQ(report.defaults[0].where, "A1, A2");
  EXPECT_EQ(report.defaults[1].where, "A2");
}

TEST(ReportFiles, KeepNumbersInFullAndQuoteWords) {
  const Report report = sampleReport();
  EXPECT_EQ(tableCsv(report.tables[0]), "word,number\n\"x, \"\"y\"\"\",1.25\nz,-\n");
  const auto json = nlohmann::json::parse(reportJson(report));
  EXPECT_EQ(json["tables"]["t"]["rows"][0]["number"], 1.25);
  EXPECT_EQ(json["claims"][0]["verdict"], "missed");
  EXPECT_EQ(json["curves"]["curve"]["run"].size(), 3u);
  EXPECT_NE(tableText(report.tables[0]).find("x, \"y\" |  1.2 %"), std::string::npos)
      << tableText(report.tables[0]);
}

TEST(ReportFiles, ThePageIsOfOnePieceAndEscapesWhatItShows) {
  const std::string html = reportHtml(sampleReport());
  EXPECT_NE(html.find("a &lt;b&gt; &amp; &quot;c&quot;"), std::string::npos);
  for (const char* outside : {"src=", "href=", "@import", "url("})
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  for (const char* part : {"<svg", "limit 10 %", "missed", "Defaults that were used", "note"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
}

/// The bytes of a data URI, decoded by somebody else.
std::string fromBase64(const std::string& text) {
  const test::TemporaryFolder folder;
  test::writeFile(folder.path() / "text", text);
  EXPECT_EQ(
      test::runProcess({"/bin/sh", "-c", "base64 -d " + (folder / "text") + " > " + (folder / "bytes")}).code,
      0);
  return test::readFile(folder.path() / "bytes");
}

TEST(ReportFiles, PicturesAreInThePageAndBesideIt) {
  Report report = sampleReport();
  std::string bytes;
  for (int i = 0; i < 256; ++i) bytes += static_cast<char>(i);
  for (const std::size_t length : {256u, 255u, 254u})  // every remainder of three
    report.pictures.push_back({"p" + std::to_string(length), length == 254 ? "Other" : "Both", "a < b",
                               "The \"caption\".", bytes.substr(0, length)});
  const std::string html = reportHtml(report), start = "src=\"data:image/png;base64,";
  std::vector<std::string> found;
  for (std::size_t at = html.find(start); at != std::string::npos; at = html.find(start, at + 1)) {
    const std::size_t begin = at + start.size();
    found.push_back(fromBase64(html.substr(begin, html.find('"', begin) - begin)));
  }
  ASSERT_EQ(found.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(found[i], report.pictures[i].png);
  EXPECT_NE(html.find("alt=\"a &lt; b: The &quot;caption&quot;.\""), std::string::npos);
  const auto count = [&](const std::string& part) {
    std::size_t times = 0;
    for (std::size_t at = html.find(part); at != std::string::npos; at = html.find(part, at + 1)) ++times;
    return times;
  };
  EXPECT_EQ(count("<div class=\"row\">"), 2u) << "one row a figure";
  EXPECT_EQ(count("<h2>Both</h2>"), 1u);

  const test::TemporaryFolder folder;
  EXPECT_EQ(writeReport(report, folder.path()).size(), 7u);
  EXPECT_EQ(test::readFile(folder.path() / "p255.png"), report.pictures[1].png);
  EXPECT_EQ(nlohmann::json::parse(reportJson(report))["pictures"][2]["file"], "p254.png");
  Report whole;
  whole.append(std::move(report));
  EXPECT_EQ(whole.pictures.size(), 3u);
}

TEST(ReportFiles, AreWrittenIntoAFolderThatIsMade) {
  const test::TemporaryFolder folder;
  const auto files = writeReport(sampleReport(), folder.path() / "new" / "deep");
  EXPECT_EQ(files.size(), 4u);
  for (const auto& file : files) EXPECT_GT(std::filesystem::file_size(file), 0u) << file;
  test::writeFile(folder.path() / "taken", "x");
  EXPECT_THROW(writeReport(sampleReport(), folder.path() / "taken"), InputError);
}

}  // namespace
}  // namespace vantage::experiments
