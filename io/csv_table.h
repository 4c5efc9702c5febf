#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <string_view>

#include "core/geometry/pose.h"

namespace vantage {

/// A table as text with commas. Rows are collected and written at the end, so that a file is whole or absent.
/// Numbers read back exactly; words that hold a comma, a quote or a line break are quoted (RFC 4180).
class CsvTable {
 public:
  /// \param header names of the columns with commas between them
  explicit CsvTable(std::string_view header);

  CsvTable& cell(double value);
  CsvTable& cell(float value);
  template <std::integral T>
  CsvTable& cell(T value) {
    return cell(std::string_view(std::to_string(value)));
  }
  CsvTable& cell(std::string_view word);
  /// A value, or an empty cell.
  template <class T>
  CsvTable& cell(const std::optional<T>& value) {
    return value ? cell(*value) : cell(std::string_view());
  }
  template <class Vector>
  CsvTable& cells(const Vector& v) {
    return cell(v[0]).cell(v[1]).cell(v[2]);
  }
  /// `x_m,y_m,z_m,qx,qy,qz,qw`
  CsvTable& pose(const Pose& pose);
  void endRow();

  const std::string& text() const { return text_; }
  /// \param path "-" is standard output. \throws InputError if the file cannot be created, std::runtime_error
  /// if it cannot be written in full.
  void save(const std::string& path) const;

 private:
  std::string text_;
  bool row_empty_ = true;
};

}  // namespace vantage
