#include <gmock/gmock.h>

#include "io/dataset.h"
#include "tests/io/data_support.h"

namespace vantage {
namespace {

TEST(BagDatasetAbsent, SaysWhichPackagesBringIt) {
  EXPECT_THAT(errorOf([] { openDataset("x.bag"); }),
              testing::AllOf(testing::HasSubstr("built without ROS"), testing::HasSubstr("libtf2-dev")));
}

}  // namespace
}  // namespace vantage
