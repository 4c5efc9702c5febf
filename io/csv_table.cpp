#include "io/csv_table.h"

#include <charconv>
#include <iostream>
#include <stdexcept>

#include "io/text_file.h"

namespace vantage {

CsvTable::CsvTable(std::string_view header) : text_(header) {
  text_ += '\n';
}

CsvTable& CsvTable::cell(double value) {
  return cell(std::string_view(shortestNumber(value)));
}

CsvTable& CsvTable::cell(float value) {
  char buffer[32];
  return cell(std::string_view(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr));
}

CsvTable& CsvTable::cell(std::string_view word) {
  if (!row_empty_) text_ += ',';
  row_empty_ = false;
  if (word.find_first_of(",\"\r\n") == std::string_view::npos) {
    text_ += word;
    return *this;
  }
  text_ += '"';
  for (const char c : word) {
    if (c == '"') text_ += c;
    text_ += c;
  }
  text_ += '"';
  return *this;
}

CsvTable& CsvTable::pose(const Pose& pose) {
  const Eigen::Quaterniond q = orientationOf(pose);
  return cells(Eigen::Vector3d(pose.translation())).cell(q.x()).cell(q.y()).cell(q.z()).cell(q.w());
}

void CsvTable::endRow() {
  text_ += '\n';
  row_empty_ = true;
}

void CsvTable::save(const std::string& path) const {
  if (path != "-") return saveFile(path, text_);
  std::cout << text_ << std::flush;
  if (!std::cout) throw std::runtime_error("standard output: cannot be written");
}

}  // namespace vantage
