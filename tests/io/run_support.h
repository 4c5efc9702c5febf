#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <random>
#include <string>

#include "io/run_fields.h"
#include "io/run_file.h"

namespace vantage::testing {

/// A folder for one test, removed at its end.
class TestFolder {
 public:
  TestFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "vantage-run-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Fills every field of anything that a run file holds with seeded random values, by the same lists of fields
/// that store them. Counts and indices that must fit together are set right afterwards.
class Randomizer : public detail::Archive<Randomizer> {
 public:
  static constexpr bool kReading = true;
  explicit Randomizer(std::uint64_t seed) : random_(seed) {}
  std::mt19937_64& random() { return random_; }

  template <class T>
  void scalar(T& value) {
    if constexpr (std::is_enum_v<T>) {
      value = static_cast<T>(random_() % kEnumCount<T>);
    } else if constexpr (std::same_as<T, bool>) {
      value = random_() & 1;
    } else if constexpr (std::is_floating_point_v<T>) {
      value = std::uniform_real_distribution<T>(-1, 1)(random_);
    } else {
      value = static_cast<T>(random_() >> 2);
    }
  }
  void text(std::string& value) { value = "text " + std::to_string(random_()); }
  template <class T>
  void optional(std::optional<T>& value) {
    (*this)(value.emplace());
  }
  template <class T>
  void vector(std::vector<T>& values) {
    values.resize(3 + random_() % 20);
    for (T& value : values) (*this)(value);
  }

 private:
  std::mt19937_64 random_;
};
inline void histograms(Randomizer& a, std::vector<std::vector<std::uint32_t>>& all) {
  a(all);
}

/// Grid of the synthetic runs; its upper bricks are cut.
inline GridGeometry testGrid() {
  return {{-0.3, -0.2, 0.1}, 0.01, {40, 21, 19}};
}

RunHeader randomHeader(std::uint64_t seed);
/// A record with every field filled.
StepRecord randomRecord(std::uint64_t seed, int step, bool closing = false);

/// All fields of both, as bytes, so that NaN equals NaN; and product by product, to name what differs.
void expectEqual(const StepRecord& a, const StepRecord& b);
bool equal(const StepRecord& a, const StepRecord& b);
bool equal(const RunHeader& a, const RunHeader& b);

/// Writes a finished run with `steps` records of seeds seed+1... and a closing record.
void writeRun(const std::filesystem::path& path, std::uint64_t seed, int steps);

}  // namespace vantage::testing
