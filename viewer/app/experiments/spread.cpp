#include "viewer/app/experiments/spread.h"

#include <fmt/format.h>

#include <cmath>

namespace vantage::experiments {

std::string Spread::text(int decimals) const {
  return deviation ? fmt::format("{:.{}f} +- {:.{}f}", mean, decimals, *deviation, decimals)
                   : fmt::format("{:.{}f}", mean, decimals);
}

Cell Spread::cell(int decimals, std::string_view unit) const {
  Cell cell = Cell::number(mean, decimals);
  cell.text = text(decimals) + std::string(unit);
  return cell;
}

Spread spreadOf(std::span<const double> values) {
  Spread result;
  const auto n = static_cast<double>(values.size());
  double squares = 0.0;
  for (const double value : values) result.mean += value / n;
  for (const double value : values) squares += std::pow(value - result.mean, 2);
  if (values.size() > 1) result.deviation = std::sqrt(squares / (n - 1));
  return result;
}

}  // namespace vantage::experiments
