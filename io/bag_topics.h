#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/bag_messages.h"
#include "io/dataset_parts.h"

namespace vantage::bag {

/// Encodings of depth: 16-bit counts (millimetres unless stated otherwise), or metres.
bool isCounts(const std::string& encoding);
bool isMetres(const std::string& encoding);

/// Where a recording has what a data set needs.
struct Topics {
  std::string depth;
  std::string camera_info;  ///< empty if the description states the camera
};

/// The topics that the description names, else the only one with depth and the camera_info in its namespace.
/// \throws InputError naming the file: none, several, another type, only compressed images
Topics chooseTopics(const BagFile& bag, const dataset::Description& description);

/// All messages of a topic as recorded, of all its publishers in ascending time.
std::vector<MessagePlace> messagesOf(const BagFile& bag, const std::string& topic);

}  // namespace vantage::bag
