#include "viewer/text_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace vantage {
namespace {

double letters(std::string_view text) {
  return static_cast<double>(text.size());
}

std::string broken(const std::string& text, double width) {
  return brokenAtSpaces(text, width, letters);
}

TEST(TextLines, EndAtSpacesAlone) {
  EXPECT_EQ(broken("one two three", 8), "one two\nthree");
  EXPECT_EQ(broken("one two three", 100), "one two three");
  EXPECT_EQ(broken("first\nsecond line", 7), "first\nsecond\nline");
  EXPECT_EQ(broken("", 7), "");
  EXPECT_EQ(broken("one two", 0), "one two") << "no width is known";
}

TEST(TextLines, NeverTearNumbersFromTheirDecimalsThousandsOrUnits) {
  EXPECT_EQ(broken("saliency 0.61 is much", 11), "saliency\n0.61 is\nmuch");
  EXPECT_EQ(broken("gains most, 35 248 rays.", 16), "gains most,\n35 248 rays.");
  EXPECT_EQ(broken("within (21 cm and", 11), "within\n(21 cm and");
  EXPECT_EQ(broken("allowed: 0.001 .. 200 mm", 20), "allowed:\n0.001 .. 200 mm");
  EXPECT_EQ(broken("at 0.61, then more", 8), "at 0.61,\nthen\nmore") << "a comma ends what belongs together";
}

TEST(TextLines, BreakWhatIsWiderThanALine) {
  EXPECT_EQ(broken("a /very/long/path b", 6), "a\n/very/\nlong/p\nath b");
  EXPECT_EQ(broken("1 2 3 4 5 6", 5), "1 2 3\n4 5 6");
  EXPECT_EQ(broken("≥≥≥", 6), "≥≥\n≥") << "letters of several bytes stay whole";
}

TEST(TextLines, KeepEveryLetterAndFitTheWidth) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 300; ++trial) {
    std::string text;
    for (int i = 0; i < 60; ++i) text += "ab 1.5 ,("[random() % 9];
    const double width = 1 + random() % 30;
    std::string lines = broken(text, width);
    for (std::size_t at = 0; at < lines.size();) {
      const std::size_t end = std::min(lines.find('\n', at), lines.size());
      EXPECT_LE(end - at, width) << text;
      at = end + 1;
    }
    const auto isGap = [](char c) { return c == ' ' || c == '\n'; };
    std::erase_if(lines, isGap);
    std::erase_if(text, isGap);
    EXPECT_EQ(lines, text);
  }
}

}  // namespace
}  // namespace vantage
