#include "io/table_file.h"

#include <charconv>
#include <cmath>
#include <iostream>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "io/csv_table.h"
#include "io/text_file.h"

namespace vantage {
namespace {

constexpr std::size_t kLargestTable = std::size_t{1} << 30;

std::string readAll(const std::string& path) {
  if (path != "-") return readTextFile(path, kLargestTable);
  std::string text(std::istreambuf_iterator<char>(std::cin), {});
  return text;
}

std::string_view trimmed(std::string_view cell) {
  const auto first = cell.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return cell.substr(first, cell.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> splitCells(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const auto comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

/// A table being read: cells by column name.
class Reader {
 public:
  Reader(std::string name, std::string_view text) : name_(std::move(name)), rest_(text) {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
    if (!next()) throw InputError(name_, "is empty; a table starts with its header row");
    for (std::size_t i = 0; i < cells_.size(); ++i) columns_.emplace(cells_[i], i);
    width_ = cells_.size();
  }

  void requireColumns(std::initializer_list<std::string_view> wanted) const {
    for (const std::string_view column : wanted)
      if (!has(column))
        throw InputError(where(),
                         "the header has no column '" + std::string(column) + "'; wanted: " + joined(wanted));
  }
  bool has(std::string_view column) const { return columns_.count(column) != 0; }

  /// Goes to the next row that is not blank.
  bool row() {
    if (!next()) return false;
    if (cells_.size() != width_)
      throw InputError(where(),
                       std::to_string(cells_.size()) + " cells; the header has " + std::to_string(width_));
    return true;
  }

  double number(std::string_view column) const {
    const std::string_view cell = cells_[columns_.at(column)];
    const auto value = parseNumber(cell);
    if (!value)
      throw InputError(where(), std::string(column) + " = '" + std::string(cell.substr(0, 40)) +
                                    "' is not a finite number");
    return *value;
  }
  std::uint32_t count(std::string_view column) const {
    const std::string_view cell = cells_[columns_.at(column)];
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size() || cell.empty())
      throw InputError(where(), std::string(column) + " = '" + std::string(cell.substr(0, 40)) +
                                    "' is not a whole number in 0 .. 4294967295");
    return value;
  }
  bool blank(std::string_view column) const { return cells_[columns_.at(column)].empty(); }
  std::string where() const { return name_ + ":" + std::to_string(line_); }

 private:
  bool next() {
    while (!rest_.empty()) {
      const auto end = rest_.find('\n');
      const std::string_view text = rest_.substr(0, end);
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      ++line_;
      if (trimmed(text).empty()) continue;
      cells_ = splitCells(text);
      return true;
    }
    return false;
  }
  static std::string joined(std::initializer_list<std::string_view> words) {
    std::string text;
    for (const std::string_view word : words) text += (text.empty() ? "" : ",") + std::string(word);
    return text;
  }

  std::string name_;
  std::string_view rest_;
  int line_ = 0;
  std::size_t width_ = 0;
  std::vector<std::string_view> cells_;
  std::map<std::string_view, std::size_t> columns_;
};

Pose poseOf(const Reader& table) {
  const Eigen::Quaterniond q(table.number("qw"), table.number("qx"), table.number("qy"), table.number("qz"));
  if (!(std::abs(q.norm() - 1.0) <= 1e-3))
    throw InputError(table.where(),
                     "the quaternion has length " + shortestNumber(q.norm()) + "; allowed: 1 within 0.001");
  return makePose({table.number("x_m"), table.number("y_m"), table.number("z_m")}, q);
}

}  // namespace

void writeContourVoxels(const std::string& path, const GridGeometry& geometry,
                        const std::vector<ContourVoxel>& voxels) {
  CsvTable table("i,j,k,x_m,y_m,z_m,nx,ny,nz,group");
  for (const ContourVoxel& v : voxels)
    table.cells(v.voxel).cells(geometry.center(v.voxel)).cells(v.normal).cell(v.group).endRow();
  table.save(path);
}

void writeContourPoints(const std::string& path, const std::vector<ContourPoint>& points) {
  CsvTable table("group,x_m,y_m,z_m,nx,ny,nz,voxels");
  for (std::size_t i = 0; i < points.size(); ++i)
    table.cell(i).cells(points[i].position_m).cells(points[i].normal).cell(points[i].voxels).endRow();
  table.save(path);
}

void writeViews(const std::string& path, const std::vector<ViewRow>& views) {
  bool groups = false;
  for (const ViewRow& view : views) groups = groups || view.group.has_value();
  CsvTable table(groups ? "id,x_m,y_m,z_m,qx,qy,qz,qw,group" : "id,x_m,y_m,z_m,qx,qy,qz,qw");
  for (const ViewRow& view : views) {
    table.cell(view.id).pose(view.T_world_camera);
    if (groups) view.group ? table.cell(*view.group) : table.cell(std::string_view());
    table.endRow();
  }
  table.save(path);
}

void writeJointPath(const std::string& path, const std::vector<std::string>& joints,
                    const JointTrajectory& trajectory) {
  std::string header = "t_s";
  for (const std::string& joint : joints) header += "," + joint;
  CsvTable table(header);
  for (std::size_t p = 0; p < trajectory.size(); ++p) {
    table.cell(trajectory.time_s[p]);
    for (const double q : trajectory.positions[p]) table.cell(q);
    table.endRow();
  }
  table.save(path);
}

void writePosePath(const std::string& path, const std::vector<double>& times_s,
                   const std::vector<Pose>& poses) {
  CsvTable table("t_s,x_m,y_m,z_m,qx,qy,qz,qw");
  for (std::size_t p = 0; p < poses.size(); ++p) {
    table.cell(times_s[p]).pose(poses[p]);
    table.endRow();
  }
  table.save(path);
}

std::vector<ViewRow> readViews(const std::string& path) {
  const std::string text = readAll(path);
  Reader table(path == "-" ? "standard input" : path, text);
  table.requireColumns({"id", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"});
  const bool groups = table.has("group");
  std::vector<ViewRow> views;
  while (table.row()) {
    ViewRow view{table.count("id"), poseOf(table), std::nullopt};
    if (groups && !table.blank("group")) view.group = table.count("group");
    views.push_back(std::move(view));
  }
  return views;
}

void writeGains(const std::string& path, const std::vector<GainRow>& gains) {
  CsvTable table("id,unknown,occupied,rays,visited,reject");
  for (const GainRow& gain : gains)
    table.cell(gain.id)
        .cell(gain.unknown)
        .cell(gain.occupied)
        .cell(gain.rays)
        .cell(gain.visited)
        .cell(gain.reject)
        .endRow();
  table.save(path);
}

void writeSegments(const std::string& path, const std::vector<Segment>& segments) {
  CsvTable table("segment,points,saliency,isolation,roundness,d1_m,d2_m,d3_m,cx_m,cy_m,cz_m,radius_m");
  for (const Segment& s : segments)
    table.cell(s.label)
        .cell(s.points)
        .cell(s.saliency)
        .cell(s.isolation)
        .cell(s.roundness)
        .cells(s.extent_m)
        .cells(s.center_m)
        .cell(s.radius_m)
        .endRow();
  table.save(path);
}

void writePlan(const std::string& path, const std::vector<PlanRow>& rows) {
  CsvTable table("id,x_m,y_m,z_m,qx,qy,qz,qw,group,segment,saliency,gain,reachability,chosen");
  for (const PlanRow& row : rows) {
    table.cell(row.view.id).pose(row.view.T_world_camera);
    row.view.group ? table.cell(*row.view.group) : table.cell(std::string_view());
    table.cell(row.segment)
        .cell(row.saliency)
        .cell(row.gain)
        .cell(row.reachability)
        .cell(row.chosen ? 1 : 0)
        .endRow();
  }
  table.save(path);
}

void writeUtilities(const std::string& path, const UtilitySearch& search) {
  CsvTable table(
      "id,x_m,y_m,z_m,qx,qy,qz,qw,reject,unknown,occupied,surface,distance,utility,rays,visited,reachability,"
      "chosen");
  const ViewUtility* chosen = chosenUtility(search);
  const auto add = [&](const ViewUtility& view) {
    table.cell(view.id).pose(view.T_world_camera).cell(tokenOf(view.rejection));
    table.cell(view.unknown).cell(view.occupied).cell(view.surface).cell(view.distance).cell(view.utility);
    table.cell(view.rays.rays_cast).cell(view.rays.visited).cell(tokenOf(view.reachability));
    table.cell(&view == chosen ? 1 : 0).endRow();
  };
  for (const std::uint32_t n : search.ranking) add(search.views[n]);
  for (const ViewUtility& view : search.views)
    if (view.rejection != ViewRejection::None) add(view);
  table.save(path);
}

}  // namespace vantage
