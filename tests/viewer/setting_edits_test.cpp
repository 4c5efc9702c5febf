#include "viewer/setting_edits.h"

#include <gtest/gtest.h>

#include <set>

#include "io/error.h"
#include "viewer/parameter_text.h"
#include "viewer/parameters.h"

namespace vantage {
namespace {

const std::string kB = "saliency.isolation_distance_m", kThreshold = "gain.threshold";

double numberOf(const config::Value& value) {
  return std::get<double>(value);
}

SettingEdits fresh() {
  SettingEdits edits;
  edits.setRecorded(Settings{});
  return edits;
}

TEST(SettingEdits, UndoAndRedoWalkThroughChanges) {
  SettingEdits edits = fresh();
  EXPECT_FALSE(edits.canUndo());
  EXPECT_TRUE(edits.set(kB, 0.05));
  edits.finishEdit();
  EXPECT_TRUE(edits.set(kThreshold, 900.0));
  edits.finishEdit();
  EXPECT_TRUE(edits.undo());
  EXPECT_EQ(numberOf(edits.value(kThreshold)), 700.0);
  EXPECT_EQ(numberOf(edits.value(kB)), 0.05);
  EXPECT_TRUE(edits.undo());
  EXPECT_FALSE(edits.undo());
  EXPECT_FALSE(edits.anyChanged());
  EXPECT_TRUE(edits.redo());
  EXPECT_TRUE(edits.redo());
  EXPECT_FALSE(edits.redo());
  EXPECT_EQ(numberOf(edits.value(kThreshold)), 900.0);
}

TEST(SettingEdits, MovesOfOneSliderAreOneUndo) {
  SettingEdits edits = fresh();
  for (const double value : {0.03, 0.04, 0.05}) edits.set(kB, value);
  edits.finishEdit();
  edits.set(kB, 0.06);
  EXPECT_TRUE(edits.undo());
  EXPECT_EQ(numberOf(edits.value(kB)), 0.05);
  EXPECT_TRUE(edits.undo());
  EXPECT_EQ(numberOf(edits.value(kB)), 0.02);
}

TEST(SettingEdits, ANewChangeForgetsWhatWasUndone) {
  SettingEdits edits = fresh();
  edits.set(kB, 0.05);
  edits.finishEdit();
  edits.undo();
  edits.set(kThreshold, 900.0);
  EXPECT_FALSE(edits.canRedo());
}

TEST(SettingEdits, RefusedValuesChangeNothingAndSayWhatIsAllowed) {
  SettingEdits edits = fresh();
  EXPECT_FALSE(edits.setText(kB, "wide"));
  EXPECT_NE(edits.error(kB).find("'wide' is not a number"), std::string::npos) << edits.error(kB);
  EXPECT_FALSE(edits.setText(kB, "900"));
  EXPECT_NE(edits.error(kB).find("200 mm"), std::string::npos) << edits.error(kB);
  EXPECT_FALSE(edits.set("segmentation.seed_m", 0.001));  // below the voxel
  EXPECT_FALSE(edits.error("segmentation.seed_m").empty());
  EXPECT_FALSE(edits.setText("views.distances_m", "[0.8, -1]"));
  EXPECT_FALSE(edits.error("views.distances_m").empty());
  EXPECT_FALSE(edits.setText("saliency.min_points", "2.5"));
  EXPECT_FALSE(edits.anyChanged());
  EXPECT_FALSE(edits.canUndo());
  EXPECT_TRUE(edits.setText(kB, "15"));
  EXPECT_EQ(edits.error(kB), "");
}

TEST(SettingEdits, ARangeThatAnotherValueSetsIsToldInTheUnitThatIsShown) {
  SettingEdits edits = fresh();
  EXPECT_FALSE(edits.setText("segmentation.seed_m", "2.5"));
  EXPECT_EQ(edits.error("segmentation.seed_m"), "2.5 mm is out of range; allowed: 7.5 .. 10 000 mm");
  EXPECT_FALSE(edits.setText("segmentation.voxel_m", "500"));
  EXPECT_NE(edits.error("segmentation.voxel_m").find("then 'VCCS seeds', "), std::string::npos);
  EXPECT_NE(edits.error("segmentation.voxel_m").find("allowed: 500 .. 10 000 mm"), std::string::npos);
}

TEST(SettingEdits, TextIsInTheUnitThatIsShown) {
  SettingEdits edits = fresh();
  EXPECT_TRUE(edits.setText(kB, " 15 mm "));
  EXPECT_DOUBLE_EQ(numberOf(edits.value(kB)), 0.015);
  EXPECT_EQ(shownText(kB, edits.value(kB)), "15");
  EXPECT_TRUE(edits.setText("views.distances_m", "[0.7, 0.9]"));
  EXPECT_EQ(shownText("views.distances_m", edits.value("views.distances_m")), "[0.7, 0.9]");
  EXPECT_TRUE(edits.setText("views.distances_m", "0.6, 0.8 m")) << "brackets may be left out";
  EXPECT_EQ(shownText("views.distances_m", edits.value("views.distances_m")), "[0.6, 0.8]");
}

TEST(SettingEdits, TomlHoldsWhatChangedAndReadsBackToIt) {
  SettingEdits edits = fresh();
  EXPECT_EQ(edits.toml().find('['), std::string::npos);
  edits.set(kB, 0.0125);
  edits.set("saliency.min_points", std::int64_t{25});
  edits.set("gain.outside", std::string("transparent"));
  edits.set("views.distances_m", std::vector<double>{0.7, 0.9});
  SettingEdits other = fresh();
  EXPECT_TRUE(other.load(edits.toml(), "test", PlannerKind::Contour).empty());
  for (const config::Field& field : config::fields())
    EXPECT_EQ(other.value(field.key), edits.value(field.key)) << field.key;
  EXPECT_TRUE(other.anyChanged());
  EXPECT_TRUE(other.undo());
  EXPECT_FALSE(other.anyChanged()) << "a file is one change";
  EXPECT_FALSE(other.canUndo());
  EXPECT_TRUE(other.redo());
  EXPECT_EQ(other.toml(), edits.toml());
}

TEST(SettingEdits, TheSummaryNamesWhatChangedInOneLine) {
  SettingEdits edits = fresh();
  EXPECT_EQ(edits.summary(), "");
  edits.set("gain.outside", std::string("transparent"));
  edits.set(kB, 0.0125);
  EXPECT_EQ(edits.summary(), kB + " = 0.0125, gain.outside = \"transparent\"");
}

TEST(SettingEdits, AFileGivesTheParametersOfThePlannerAloneAndTheOthersAreNamed) {
  SettingEdits edits = fresh();
  const std::string file =
      "[exploration]\nsteps = 77\n[gain]\nthreshold = 900\n[utility]\nmin_occupied = 33\n[scan]\n"
      "frames = 77\n";
  const std::vector<std::string> others = edits.load(file, "file", PlannerKind::Contour);
  EXPECT_EQ(std::set<std::string>(others.begin(), others.end()),
            (std::set<std::string>{"exploration.steps", "scan.frames", "utility.min_occupied"}));
  EXPECT_EQ(numberOf(edits.value(kThreshold)), 900.0);
  for (const std::string& key : others) EXPECT_FALSE(edits.changed(key)) << key;
  EXPECT_EQ(edits.toml().find("steps"), std::string::npos);
  edits.resetAll();
  EXPECT_EQ(edits.load(file, "file", PlannerKind::Uniform).size(), 3u);
  EXPECT_TRUE(edits.changed("utility.min_occupied"));
  EXPECT_FALSE(edits.changed(kThreshold));
}

TEST(SettingEdits, ValuesOfAFileThatDoNotFitTogetherChangeNothing) {
  SettingEdits edits = fresh();
  EXPECT_THROW(edits.load("[segmentation]\nvoxel_m = 0.03\nseed_m = 0.01\n", "file", PlannerKind::Contour),
               std::exception);
  EXPECT_FALSE(edits.anyChanged());
  EXPECT_FALSE(edits.canUndo());
}

TEST(SettingEdits, ABrokenFileChangesNothing) {
  SettingEdits edits = fresh();
  EXPECT_THROW(edits.load("[saliency]\nisolation_distance_m = 0.01\nno_such_key = 1\n", "broken",
                          PlannerKind::Contour),
               InputError);
  EXPECT_FALSE(edits.anyChanged());
}

TEST(SettingEdits, ResetAllComesBackInOneGo) {
  SettingEdits edits = fresh();
  edits.set("segmentation.voxel_m", 0.02);
  edits.finishEdit();
  edits.set("segmentation.seed_m", 0.06);
  edits.finishEdit();
  const std::string changed = edits.toml();
  EXPECT_TRUE(edits.resetAll());
  EXPECT_FALSE(edits.anyChanged());
  EXPECT_FALSE(edits.resetAll());
  EXPECT_TRUE(edits.undo());
  EXPECT_EQ(edits.toml(), changed);
  EXPECT_TRUE(edits.redo());
  EXPECT_FALSE(edits.anyChanged());
}

TEST(SettingEdits, EveryStateOnTheWayBackIsValid) {
  SettingEdits edits = fresh();
  edits.set("segmentation.voxel_m", 0.003);
  edits.finishEdit();
  ASSERT_TRUE(edits.set("segmentation.seed_m", 0.004));  // too fine for the run's own voxel
  edits.resetAll();
  while (edits.undo()) EXPECT_NO_THROW(edits.wanted().validate());
  while (edits.redo()) EXPECT_NO_THROW(edits.wanted().validate());
}

TEST(Parameters, EveryOneIsASettingWithASliderInsideItsRange) {
  int sliders = 0;
  for (const PlannerKind planner : kPlannerKinds) {
    for (const ParameterGroup& group : parametersOf(planner)) {
      for (const Parameter& p : group.parameters) {
        const config::Field* field = config::find(p.key);
        ASSERT_NE(field, nullptr) << p.key;
        if (p.high <= p.low) continue;
        ++sliders;
        EXPECT_GE(p.low, field->low) << p.key;
        EXPECT_LE(p.high, field->high) << p.key;
        EXPECT_TRUE(!p.logarithmic || p.low > 0.0) << p.key;
        if (p.paper) {
          EXPECT_TRUE(*p.paper >= p.low && *p.paper <= p.high) << p.key;
        }
      }
    }
  }
  EXPECT_GT(sliders, 40);
}

TEST(Parameters, AllSettingsOfThePlannersAreOffered) {
  for (const config::Field& field : config::fields()) {
    const bool of_other_steps =
        field.key.find("disappointing") != std::string::npos || field.key == "candidates.recorded";
    if (of_other_steps) continue;
    const std::string section = field.key.substr(0, field.key.find('.'));
    const bool contour = section == "contours" || section == "views" || section == "segmentation" ||
                         section == "saliency" || section == "gain";
    const bool octree = section == "rays" || section == "candidates" || section == "utility";
    if (contour || octree) {
      EXPECT_NE(parameterOf(field.key), nullptr) << field.key;
    }
  }
}

TEST(Parameters, NamesSayWhatTheyAreWithoutTheOnesBeside) {
  for (const PlannerKind planner : kPlannerKinds)
    for (const ParameterGroup& group : parametersOf(planner))
      for (const Parameter& p : group.parameters)
        for (const char* part_of_a_sentence : {"as ", "and ", "or "})
          EXPECT_FALSE(p.label.starts_with(part_of_a_sentence) || p.label.ends_with(" is")) << p.label;
}

}  // namespace
}  // namespace vantage
