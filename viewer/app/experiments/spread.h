#pragma once

#include <optional>
#include <span>
#include <string>

#include "viewer/app/experiments/report.h"

namespace vantage::experiments {

/// Mean and, of two values or more, sample standard deviation.
struct Spread {
  double mean = 0.0;
  std::optional<double> deviation;
  /// "1.2 +- 0.3", or the mean alone.
  std::string text(int decimals) const;
  /// The text with a unit behind it; machines read the mean.
  Cell cell(int decimals = 0, std::string_view unit = "") const;
};

/// Of no values: a mean of 0.
Spread spreadOf(std::span<const double> values);

}  // namespace vantage::experiments
