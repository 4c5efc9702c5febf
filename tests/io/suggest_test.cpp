#include "io/suggest.h"

#include <gtest/gtest.h>

#include <vector>

namespace vantage {
namespace {

const std::vector<std::string> kWords = {"contour", "standard", "camera.width", "camera.height"};

TEST(Nearest, FindsTheWordBehindATypingError) {
  EXPECT_EQ(nearest("contor", kWords), "contour");
  EXPECT_EQ(nearest("camera.widht", kWords), "camera.width");
  EXPECT_EQ(nearest("Standart", kWords), "standard");
}

TEST(Nearest, GivesTheFirstOfEquallyNearWords) {
  const std::vector<std::string> twins = {"ab", "ac"};
  EXPECT_EQ(nearest("ad", twins), "ab");
}

TEST(Nearest, HasNoSuggestionForSomethingElse) {
  EXPECT_EQ(nearest("xyzzyplugh", kWords), "");
  EXPECT_EQ(nearest("", kWords), "");
  EXPECT_EQ(nearest("contour", {}), "");
  EXPECT_EQ(nearest(std::string(100000, 'c'), kWords), "");
}

}  // namespace
}  // namespace vantage
