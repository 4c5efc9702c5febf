#include "viewer/legend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "viewer/captions.h"

namespace vantage {
namespace {

TextStyle small(double unit) {
  TextStyle style;
  style.size_px = static_cast<int>(std::lround(14.0 * unit));
  return style;
}

/// A fill with a mark on it, as a picture.
RgbImage swatch(const LegendEntry& entry) {
  constexpr int kWidth = 40, kHeight = 26, kHalf = kHeight / 2;
  RgbImage image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int u = std::abs(x - kWidth / 2), v = std::abs(y - kHalf);
      const bool ring = std::abs(std::hypot(u, v) - (kHalf - 4)) <= 1.2;
      const bool marked = entry.mark == LegendEntry::Mark::Crossed  ? std::abs(u - v) <= 1 && u <= kHalf - 3
                          : entry.mark == LegendEntry::Mark::Ringed ? ring
                          : entry.mark == LegendEntry::Mark::Striped
                              ? x % 10 >= 4 && x % 10 < 7 && v < kHalf - 3
                              : u + v <= kHalf - 4;
      image.set(x, y, (marked ? palette::kInk : entry.color).bytes());
    }
  }
  return image;
}

void drawMark(Page& page, double x, double y, const LegendEntry& entry, double unit) {
  const double w = 20.0 * unit, h = 13.0 * unit, middle = y + h / 2;
  switch (entry.mark) {
    case LegendEntry::Mark::Fill:
      page.rectangle(x, y, w, h, entry.color, entry.opacity);
      page.frame(x, y, w, h, palette::kFaintInk);
      break;
    case LegendEntry::Mark::Line:
      page.line(x, middle, x + w, middle, entry.color, 3.0 * unit);
      break;
    case LegendEntry::Mark::Dashed:
      for (int i = 0; i < 3; ++i) {
        page.line(x + i * 7.5 * unit, middle, x + (i * 7.5 + 5.0) * unit, middle, entry.color, 3.0 * unit);
      }
      break;
    case LegendEntry::Mark::Dot:
      page.disc(x + w / 2, middle, 4.5 * unit, entry.color);
      break;
    case LegendEntry::Mark::Cross:
      page.line(x + 4 * unit, y, x + 4 * unit + h, y + h, entry.color, 2.0 * unit);
      page.line(x + 4 * unit, y + h, x + 4 * unit + h, y, entry.color, 2.0 * unit);
      break;
    case LegendEntry::Mark::Crossed:
    case LegendEntry::Mark::Striped:
    case LegendEntry::Mark::Diamond:
    case LegendEntry::Mark::Ringed:
      page.picture(x, y, w, h, swatch(entry));
      page.frame(x, y, w, h, palette::kFaintInk);
      break;
  }
}

std::string tickText(double value, double span) {
  if (value == 0.0) return "0";
  if (span >= 50.0) return grouped(static_cast<std::uint64_t>(std::max(0.0, std::round(value))));
  // Three digits of the span.
  const int digits =
      span >= 5.0 ? 1 : std::clamp(2 - static_cast<int>(std::floor(std::log10(span) + 0.31)), 2, 9);
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

double drawInset(Page& page, double x, double y, double width, const Inset& inset, double unit) {
  page.text(x, y, inset.title, small(unit));
  y += 21.0 * unit;
  const double height = width * inset.image.height / std::max(1, inset.image.width);
  page.picture(x, y, width, height, inset.image);
  page.frame(x, y, width, height, palette::kFaintInk);
  return drawScale(page, x, y + height + 12.0 * unit, width, inset.scale, unit);
}

}  // namespace

double drawScale(Page& page, double x, double y, double width, const ColorScale& scale, double unit) {
  TextStyle style = small(unit);
  y = page.paragraph(x, y, width, scale.title, style) + 2.0 * unit;
  const double height = 14.0 * unit;
  page.colorStrip(x, y, width, height, scale.map);
  page.frame(x, y, width, height, palette::kFaintInk);
  style.size_px = static_cast<int>(std::lround(12.5 * unit));
  const double span = scale.high - scale.low;
  // Long numbers would touch.
  const bool narrow = width < 240.0 * unit;
  const bool few = span >= 1e4 || span < 0.02 || (narrow && (span >= 500.0 || span < 0.5));
  const int ticks = few ? 3 : 5;
  for (int i = 0; i < ticks; ++i) {
    const double at = x + width * i / (ticks - 1);
    page.line(at, y + height, at, y + height + 4.0 * unit, palette::kFaintInk);
    style.horizontal = i == 0           ? HorizontalAlign::Left
                       : i == ticks - 1 ? HorizontalAlign::Right
                                        : HorizontalAlign::Center;
    std::string text = tickText(scale.low + span * i / (ticks - 1), span);
    if (i == ticks - 1 && scale.open_top) text = "≥ " + text;
    page.text(at, y + height + 6.0 * unit, text, style);
  }
  return y + height + 32.0 * unit;
}

double drawLegend(Page& page, const PageArea& area, std::span<const LayerNotes* const> contents,
                  double unit) {
  double y = area.y;
  const double text_x = area.x + 30.0 * unit;
  std::set<std::string> written;
  for (const LayerNotes* content : contents) {
    for (const LegendEntry& entry : content->legend) {
      if (!written.insert(entry.text).second) continue;
      drawMark(page, area.x, y + 2.0 * unit, entry, unit);
      y = page.paragraph(text_x, y, area.x + area.width - text_x, entry.text, small(unit)) + 7.0 * unit;
    }
  }
  y += 10.0 * unit;
  for (const LayerNotes* content : contents) {
    if (content->scale) y = drawScale(page, area.x, y, area.width, *content->scale, unit) + 6.0 * unit;
  }
  for (const LayerNotes* content : contents) {
    if (content->inset) y = drawInset(page, area.x, y, area.width, *content->inset, unit) + 6.0 * unit;
  }
  return y;
}

}  // namespace vantage
