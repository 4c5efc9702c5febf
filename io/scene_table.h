#pragma once

#include <toml++/toml.h>

#include <Eigen/Core>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace vantage {

/// Reads the keys of one TOML table; every error names source and line. For readers of TOML files.
class SceneTable {
 public:
  /// \param what names the table in messages, e.g. "solid 3 (box)".
  SceneTable(const toml::table& table, std::string source, std::string what);

  void setWhat(std::string what) { what_ = std::move(what); }
  bool has(const std::string& key) const { return table_.contains(key); }

  // The first form requires the key, the second has a default.
  double number(const std::string& key);
  double number(const std::string& key, double fallback);
  std::string text(const std::string& key);
  std::string text(const std::string& key, const std::string& fallback);
  bool flag(const std::string& key, bool fallback);
  /// Array of exactly `count` finite numbers.
  std::vector<double> numbers(const std::string& key, std::size_t count);
  /// Array of at most 10000 arrays of exactly `count` finite numbers.
  std::vector<std::vector<double>> points(const std::string& key, std::size_t count);

  /// Keys that are read elsewhere.
  void accept(const std::vector<std::string>& keys) { read_.insert(keys.begin(), keys.end()); }
  /// Refuses keys that were not read.
  void finish() const;

  /// \throws InputError at the key's line, or the table's if it is absent.
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;

 private:
  const toml::node& require(const std::string& key);
  double finiteNumber(const toml::node& node, const std::string& key) const;
  std::vector<double> numberArray(const toml::node& node, const std::string& key, std::size_t count) const;

  const toml::table& table_;
  std::string source_;
  std::string what_;
  std::set<std::string> read_;
};

/// `SOURCE:LINE` of a place in a TOML document.
std::string tomlPlace(const std::string& source, const toml::source_region& region);

/// Name of the document that a node was parsed from; empty if it was made in memory.
std::string sourceOf(const toml::node& node);

}  // namespace vantage
