#include "io/bag_dataset.h"

namespace vantage::dataset {

Dataset openBag(const std::filesystem::path& path, const Description&) {
  throw InputError(path.string(),
                   "is a recording of ROS 1, and this program was built without ROS; packages libtf2-dev, "
                   "liblz4-dev and libbz2-dev bring it to the next build (VANTAGE_ROS)");
}

}  // namespace vantage::dataset
