#include "viewer/panels/plot.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "viewer/panels/widgets.h"

namespace vantage {

void faintText(const Theme& theme, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, packed(theme.faint));
  wrappedText(text);
  ImGui::PopStyleColor();
}

std::vector<double> ticks(double largest, int wanted) {
  if (!(largest > 0.0) || wanted < 1) return {0.0};
  const double rough = largest / wanted, unit = std::pow(10.0, std::floor(std::log10(rough)));
  double step = unit * 10.0;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (unit * factor >= rough - 1e-12 * rough) {
      step = unit * factor;
      break;
    }
  }
  std::vector<double> values;
  for (int i = 0; (i - 1) * step < largest * (1.0 - 1e-9); ++i) values.push_back(i * step);
  return values;
}

std::string shortNumber(double value) {
  std::array<char, 32> text;
  const double size = std::abs(value);
  if (size >= 1e6)
    std::snprintf(text.data(), text.size(), "%.3g M", value / 1e6);
  else if (size >= 1e4)
    std::snprintf(text.data(), text.size(), "%.3g k", value / 1e3);
  else
    std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

}  // namespace vantage
