// Pictures inside of the page, so that it can be sent as one file.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "viewer/app/experiments/report.h"

namespace vantage::experiments {
namespace {

/// RFC 4648, section 4.
std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t n = 0; n < 3; ++n)
      group = group << 8 | (n < count ? static_cast<unsigned char>(bytes[i + n]) : 0u);
    for (std::size_t n = 0; n < 4; ++n) text += n <= count ? kDigits[group >> (18 - 6 * n) & 63] : '=';
  }
  return text;
}

std::string figureHtml(const Picture& picture) {
  return fmt::format(
      "<figure><img tabindex=\"0\" alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption><b>{2}</b>: "
      "{3}</figcaption></figure>\n",
      escaped(picture.title + ": " + picture.caption), base64(picture.png), escaped(picture.title),
      escaped(picture.caption));
}

}  // namespace

std::string picturesHtml(const std::vector<Picture>& pictures) {
  std::string html;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const bool first = i == 0 || pictures[i].figure != pictures[i - 1].figure;
    const bool last = i + 1 == pictures.size() || pictures[i].figure != pictures[i + 1].figure;
    if (first) html += "<h2>" + escaped(pictures[i].figure) + "</h2>\n<div class=\"row\">\n";
    html += figureHtml(pictures[i]);
    if (last) html += "</div>\n";
  }
  return html;
}

}  // namespace vantage::experiments
