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
