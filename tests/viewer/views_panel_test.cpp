// The panels about views, driven in the window without a display.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/gpu/egl_context.h"
#include "io/run_file.h"
#include "tests/support/synthetic_record.h"
#include "tests/viewer/inspector_driver.h"
#include "viewer/candidates.h"
#include "viewer/inspector.h"
#include "viewer/inspector_model.h"
#include "viewer/offscreen_ui.h"

namespace vantage {
namespace {

using testing::InspectorDriver;

/// A window in which a run of three steps is open; what was realised is known of the first two.
class ViewsPanel : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("vantage-views-panel-" +
               std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }

  void TearDown() override {
    ui_.reset();
    inspector_.reset();
    std::filesystem::remove_all(folder_);
  }

  template <class Run>
  void open(const Run& run) {
    const std::filesystem::path file = folder_ / "run.vantage";
    {
      RunWriter writer(file, run.header);
      for (int step = 1; step <= 3; ++step) {
        StepRecord record = run.record;
        record.step = step;
        writer.write(record);
        record.realised_voxels = record.chosen()->gain_voxels * step / 3;
        if (step < 3) writer.setRealised(record);
      }
      writer.finish("enough");
    }
    gl_ = std::make_unique<EglContext>();
    InspectorPorts ports;
    ports.copy = [](const std::string&) {};
    inspector_ = std::make_unique<Inspector>(*gl_, ports, Preferences());
    ui_ = std::make_unique<OffscreenUi>(*gl_, *inspector_, 1280, 800);
    inspector_->open({file});
    ui_->settle();
  }

  InspectorModel& model() { return inspector_->model(); }

  /// Candidates whose rows are on the screen, from above.
  std::vector<std::uint32_t> visibleRows() {
    std::vector<std::pair<double, std::uint32_t>> rows;
    const std::string prefix = "candidates/row ";
    for (const std::string& name : inspector_->widgets().names())
      if (name.starts_with(prefix))
        rows.emplace_back(inspector_->widgets().find(name)->top, std::stoul(name.substr(prefix.size())));
    std::ranges::sort(rows);
    std::vector<std::uint32_t> ids;
    for (const auto& [top, id] : rows) ids.push_back(id);
    return ids;
  }

  CandidateRow rowOf(std::uint32_t id) {
    for (const CandidateRow& row : candidateRows(model().shown().frame()))
      if (!row.pending() && row.id == id) return row;
    ADD_FAILURE() << "no row of view " << id;
    return {};
  }

  /// What the 3-D view shows.
  RgbImage picture() { return InspectorDriver::part(ui_->image(), *inspector_->widgets().find("view")); }

  std::filesystem::path folder_;
  std::unique_ptr<EglContext> gl_;
  std::unique_ptr<Inspector> inspector_;
  std::unique_ptr<OffscreenUi> ui_;
};

TEST_F(ViewsPanel, SortsByAnyColumn) {
  open(test::makeSyntheticRun());
  std::vector<std::uint32_t> ids = visibleRows();
  ASSERT_GT(ids.size(), 5u);
  for (std::size_t i = 1; i < ids.size(); ++i) EXPECT_EQ(*rowOf(ids[i]).rank, *rowOf(ids[i - 1]).rank + 1);
  ui_->click("candidates/column gain");
  ids = visibleRows();
  EXPECT_TRUE(
      std::ranges::is_sorted(ids, std::greater<>(), [&](std::uint32_t id) { return rowOf(id).score; }));
  ui_->click("candidates/column gain");
  ids = visibleRows();
  EXPECT_TRUE(std::ranges::is_sorted(ids, {}, [&](std::uint32_t id) { return rowOf(id).score; }));
  EXPECT_LT(rowOf(ids.front()).score, model().recorded().record->search->chosen->gain);
}

TEST_F(ViewsPanel, ClickingARowSelectsItsView) {
  open(test::makeSyntheticRun());
  const std::uint32_t chosen = model().recorded().record->search->chosen->id;
  const std::vector<std::uint32_t> ids = visibleRows();
  const auto other = std::ranges::find_if(ids, [&](std::uint32_t id) { return id != chosen; });
  ASSERT_NE(other, ids.end());
  ui_->click("candidates/row " + std::to_string(*other));
  EXPECT_EQ(model().selected_view, *other);
  ui_->click("explain/select winner");
  EXPECT_EQ(model().selected_view, chosen);
  ui_->frame();
  EXPECT_FALSE(ui_->has("explain/select winner"));
}

TEST_F(ViewsPanel, SelectingElsewhereScrollsTheTable) {
  open(test::makeSyntheticRun());
  const std::vector<CandidateRow> rows = candidateRows(model().shown().frame());
  const auto last =
      std::ranges::max_element(rows, {}, [](const CandidateRow& r) { return r.rank.value_or(0); });
  ASSERT_GT(*last->rank, visibleRows().size());
  const std::string name = "candidates/row " + std::to_string(last->id);
  EXPECT_FALSE(ui_->has(name));
  model().selected_view = last->id;
  ui_->frame();
  ui_->frame();
  ASSERT_TRUE(ui_->has(name));
  EXPECT_TRUE(inspector_->widgets().find(name)->visible);
}

TEST_F(ViewsPanel, ArrowKeysSelectUpAndDownTheTable) {
  open(test::makeSyntheticRun());
  const std::vector<std::uint32_t> ids = visibleRows();
  ASSERT_GT(ids.size(), 3u);
  ui_->click("candidates/row " + std::to_string(ids[1]));
  ui_->press({Key::Down});
  EXPECT_EQ(model().selected_view, ids[2]);
  ui_->press({Key::Up});
  ui_->press({Key::Up});
  EXPECT_EQ(model().selected_view, ids[0]);
}

TEST_F(ViewsPanel, FilterFindsAView) {
  open(test::makeSyntheticRun());
  const CandidateRow wanted = candidateRows(model().shown().frame()).back();
  const std::string id = std::to_string(wanted.id);
  ui_->enter("candidates/filter", id);
  ui_->frame();
  const std::vector<std::uint32_t> ids = visibleRows();
  ASSERT_FALSE(ids.empty());
  for (const std::uint32_t shown : ids) EXPECT_NE(std::to_string(shown).find(id), std::string::npos);
  ui_->enter("candidates/filter", "no such view");
  ui_->frame();
  EXPECT_TRUE(visibleRows().empty());
}

TEST_F(ViewsPanel, ListsTheSegmentOfTheSelectedViewAlone) {
  open(test::makeSyntheticRun());
  const std::uint32_t group = model().recorded().record->search->chosen->search;
  ui_->click("candidates/segment only");
  ui_->click("candidates/column segment");
  ui_->click("candidates/column segment");
  ASSERT_FALSE(visibleRows().empty());
  for (const std::uint32_t id : visibleRows()) EXPECT_EQ(rowOf(id).group, group);
}

TEST_F(ViewsPanel, ShowsWhatAViewCounts) {
  open(test::makeSyntheticRun());
  const auto shown = [&] { return inspector_->preferences().view.layers.has(Layer::HitVoxels); };
  if (shown()) ui_->click("explain/show counted");
  ASSERT_FALSE(shown());
  ui_->moveMouse(5, 790);
  ui_->settle();
  const RgbImage before = picture();
  ui_->click("explain/show counted");
  EXPECT_TRUE(shown());
  EXPECT_TRUE(inspector_->preferences().view.layers.has(Layer::Occluders));
  EXPECT_FALSE(inspector_->preferences().view.layers.has(Layer::CoarseRays));
  ui_->press({keyOf('O')});  // without the occluders
  ui_->moveMouse(5, 790);
  ui_->settle();
  EXPECT_GT(InspectorDriver::differing(before, picture()), 200) << "voxels are lit";
}

TEST_F(ViewsPanel, ShowsTheRaysOfAViewOfTheHierarchicalPlanner) {
  open(test::makeSyntheticOctreeRun());
  ui_->click("candidates/column utility");
  const std::vector<std::uint32_t> ids = visibleRows();
  ASSERT_GT(ids.size(), 5u);
  EXPECT_TRUE(
      std::ranges::is_sorted(ids, std::greater<>(), [&](std::uint32_t id) { return rowOf(id).score; }));
  inspector_->model().selected_view = ids[1];
  ui_->frame();
  ui_->click("explain/show counted");
  EXPECT_TRUE(inspector_->preferences().view.layers.has(Layer::CoarseRays));
  EXPECT_TRUE(inspector_->preferences().view.layers.has(Layer::RefinedRays));
}

TEST_F(ViewsPanel, ClickingAPointGoesToItsStep) {
  open(test::makeSyntheticRun());
  ui_->click("tab/Gains");
  ui_->frame();
  ASSERT_TRUE(ui_->has("gains/point 2"));
  ui_->click("gains/point 2");
  EXPECT_EQ(model().place().step, 1);
  EXPECT_FALSE(ui_->has("gains/point 3")) << "its scan is not fused yet";
  ui_->click("gains/missing 3");
  EXPECT_EQ(model().place().step, 2);
}

}  // namespace
}  // namespace vantage
