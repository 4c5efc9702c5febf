#include <set>

#include "io/run_schema.h"

namespace vantage {
namespace {

std::set<std::string> columnsOf(Database& database, const std::string& table) {
  std::set<std::string> names;
  Statement s(database, "SELECT name FROM pragma_table_info('" + table + "')");
  while (s.next()) names.insert(s.text(0));
  return names;
}

/// Reads the columns of a row in the order in which they were selected.
class Row {
 public:
  explicit Row(const Statement& statement) : statement_(statement) {}
  std::string text() { return statement_.text(column_++); }
  std::int64_t integer() { return statement_.integer(column_++); }
  double real() { return statement_.real(column_++); }
  void take(std::optional<double>& value) {
    if (!statement_.isNull(column_)) value = statement_.real(column_);
    ++column_;
  }
  template <class T>
  void take(std::optional<T>& value) {
    if (!statement_.isNull(column_)) value = static_cast<T>(statement_.integer(column_));
    ++column_;
  }

 private:
  const Statement& statement_;
  int column_ = 0;
};

/// "a, b, NULL, ...": NULL for what an old run does not have.
std::string select(const std::vector<std::string>& wanted, const std::set<std::string>& there) {
  std::string text;
  for (const std::string& column : wanted)
    text += (text.empty() ? "" : ", ") + (there.contains(column) ? column : "NULL");
  return text;
}

const std::vector<std::string> kOfTheMap = {
    "step",     "unknown_voxels", "unknown_near_objects", "unknown_in_boxes",
    "coverage", "box_unknown",    "box_occupied"};

void takeMap(Row& row, StepSummary& summary) {
  summary.step = static_cast<int>(row.integer());
  summary.unknown_voxels = static_cast<std::uint64_t>(row.integer());
  row.take(summary.unknown_near_objects);
  row.take(summary.unknown_in_boxes);
  row.take(summary.coverage);
  row.take(summary.box_unknown);
  row.take(summary.box_occupied);
}

const std::vector<std::string> kOfTheStep = {
    "status",        "planner",       "gain",     "gain_voxels",     "realised_voxels", "saliency", "utility",
    "path_length_m", "toward_object", "segments", "poses_generated", "poses_scored",    "rays"};
constexpr const char* kPlanningTime =
    "ifnull(contours_s,0)+ifnull(surface_s,0)+ifnull(segmentation_s,0)+ifnull(saliency_s,0)+ifnull("
    "generation_s,0)+"
    "ifnull(evaluation_s,0)+ifnull(collision_map_s,0)+ifnull(motion_planning_s,0)";

void takeStep(Row& row, StepSummary& summary) {
  summary.has_view = row.text() == "view";
  summary.planner = row.text();
  row.take(summary.gain);
  row.take(summary.gain_voxels);
  row.take(summary.realised_voxels);
  row.take(summary.saliency);
  row.take(summary.utility);
  row.take(summary.path_length_m);
  row.take(summary.toward_object);
  row.take(summary.segments);
  row.take(summary.poses_generated);
  row.take(summary.poses_scored);
  row.take(summary.rays);
  summary.planning_s = row.real();
}

}  // namespace

std::vector<StepSummary> readSummaries(Database& database) {
  std::vector<StepSummary> all;
  const std::set<std::string> columns = columnsOf(database, "step");
  Statement steps(database, "SELECT " + select(kOfTheMap, columns) + ", " + select(kOfTheStep, columns) +
                                ", " + kPlanningTime + " FROM step ORDER BY step");
  while (steps.next()) {
    Row row(steps);
    takeMap(row, all.emplace_back());
    takeStep(row, all.back());
  }
  Statement closing(database, "SELECT " + select(kOfTheMap, columnsOf(database, "closing")) +
                                  " FROM closing ORDER BY step");
  while (closing.next()) {
    Row row(closing);
    takeMap(row, all.emplace_back());
    all.back().closing = true;
  }
  return all;
}

}  // namespace vantage
