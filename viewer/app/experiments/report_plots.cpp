#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "viewer/app/experiments/report.h"

namespace vantage::experiments {
namespace {

/// Safe for colour-blind readers (Okabe & Ito 2008); curves of one colour differ by their dashes.
constexpr std::array kColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000"};
constexpr std::array kDashes = {"", "6 3", "2 3"};

/// 1, 2 or 5 times a power of ten: about five steps up to `top`.
double niceStep(double top) {
  const double raw = std::max(top, 1e-12) / 5, decade = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double m : {1.0, 2.0, 5.0})
    if (raw <= m * decade) return m * decade;
  return 10 * decade;
}

std::string text(double x, double y, std::string_view anchor, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     escaped(words));
}

std::string line(double x0, double y0, double x1, double y1, std::string_view stroke) {
  return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\"/>\n", x0, y0, x1, y1, stroke);
}

std::string svg(double width, double height, const std::string& title, const std::string& body) {
  return fmt::format(
      "<figure><figcaption>{0}</figcaption><svg viewBox=\"0 0 {1:.0f} {2:.0f}\" width=\"{1:.0f}\" "
      "height=\"{2:.0f}\" role=\"img\" aria-label=\"{0}\" font-family=\"system-ui,sans-serif\" "
      "font-size=\"11\" fill=\"#222\">\n{3}</svg></figure>\n",
      escaped(title), width, height, body);
}

std::string curve(const LinePlot::Series& series, std::size_t number, const auto& x_of, const auto& y_of) {
  std::string path;
  for (std::size_t i = 0; i < series.values.size(); ++i)
    path += fmt::format("{}{:.1f} {:.1f}", i ? "L" : "M", x_of(i + 1), y_of(series.values[i]));
  return fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" stroke-dasharray=\"{}\"/>\n", path,
      kColors[number % kColors.size()], kDashes[number / kColors.size() % kDashes.size()]);
}

}  // namespace

std::string plotSvg(const LinePlot& plot) {
  constexpr double kWidth = 900, kLeft = 70, kRight = 640, kTop = 30;
  const double bottom = std::max(260.0, 30 + 14.0 * static_cast<double>(plot.series.size()));
  double top = 0;
  std::size_t most = 2;
  for (const LinePlot::Series& series : plot.series) {
    most = std::max(most, series.values.size());
    for (const double value : series.values) top = std::max(top, value);
  }
  const double step = niceStep(top), last = step * std::max(1.0, std::ceil(top / step));
  const auto x_of = [&](std::size_t i) {
    return kLeft + (kRight - kLeft) * static_cast<double>(i - 1) / static_cast<double>(most - 1);
  };
  const auto y_of = [&](double value) { return bottom - (bottom - kTop) * value / last; };
  std::string body;
  for (double tick = 0; tick <= last * 1.001; tick += step) {
    body += line(kLeft, y_of(tick), kRight, y_of(tick), "#ddd");
    body += text(kLeft - 6, y_of(tick) + 4, "end", fmt::format("{:g}", tick));
  }
  for (std::size_t i = 1; i <= most; ++i) body += text(x_of(i), bottom + 16, "middle", std::to_string(i));
  body += text((kLeft + kRight) / 2, bottom + 34, "middle", plot.x_label);
  body += text(kLeft - 60, 12, "start", plot.y_label);
  for (std::size_t n = 0; n < plot.series.size(); ++n) {
    body += curve(plot.series[n], n, x_of, y_of);
    const double y = kTop + 10 + 14.0 * static_cast<double>(n);
    body += fmt::format(
        "<path d=\"M{:.0f} {:.1f}h22\" stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"{}\"/>\n",
        kRight + 15, y - 4, kColors[n % kColors.size()], kDashes[n / kColors.size() % kDashes.size()]);
    body += text(kRight + 42, y, "start", plot.series[n].label);
  }
  return svg(kWidth, bottom + 42, plot.title, body);
}

std::string plotSvg(const BarPlot& plot) {
  constexpr double kWidth = 900, kLeft = 300, kRight = 820, kRow = 18;
  double top = plot.limit.value_or(0.0);
  for (const BarPlot::Bar& bar : plot.bars) top = std::max(top, bar.value);
  const double bottom = 10 + kRow * static_cast<double>(plot.bars.size());
  const auto x_of = [&](double value) { return kLeft + (kRight - kLeft) * value / std::max(top, 1e-12); };
  std::string body;
  for (std::size_t n = 0; n < plot.bars.size(); ++n) {
    const BarPlot::Bar& bar = plot.bars[n];
    const double y = 6 + kRow * static_cast<double>(n);
    const bool over = plot.limit && bar.value > *plot.limit;
    body += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
                        kLeft, y, x_of(bar.value) - kLeft, kRow - 5, over ? "#d55e00" : "#0072b2");
    body += text(kLeft - 6, y + 10, "end", bar.label);
    body += text(x_of(bar.value) + 4, y + 10, "start", fmt::format("{:.3g}{}", bar.value, plot.unit));
  }
  if (plot.limit) {
    body += line(x_of(*plot.limit), 2, x_of(*plot.limit), bottom, "#222");
    body +=
        text(x_of(*plot.limit), bottom + 14, "middle", fmt::format("limit {:g}{}", *plot.limit, plot.unit));
  }
  return svg(kWidth, bottom + 20, plot.title, body);
}

}  // namespace vantage::experiments
