#include "io/bag_topics.h"

#include <algorithm>
#include <map>

namespace vantage::bag {
namespace {

constexpr std::size_t kMostListed = 12;

struct Topic {
  Content content = Content::Other;
  std::string type;
  std::string encoding;  ///< of an image topic's first message
};

using TopicList = std::map<std::string, Topic>;

/// Topics with at least one message.
TopicList listTopics(const BagFile& bag) {
  TopicList topics;
  for (const Connection& connection : bag.connections()) {
    if (connection.messages.empty() || topics.contains(connection.topic)) continue;
    Topic topic{contentOf(bag, connection), connection.type, {}};
    if (topic.content == Content::Image)
      topic.encoding = parseImage(bag, bag.read(connection.messages.front())).encoding;
    topics[connection.topic] = std::move(topic);
  }
  return topics;
}

template <typename Matches>
std::vector<std::string> namesOf(const TopicList& topics, const Matches& matches) {
  std::vector<std::string> names;
  for (const auto& [name, topic] : topics)
    if (matches(name, topic)) names.push_back(name);
  return names;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostListed); ++i)
    text += (i == 0 ? "" : ", ") + quoted(names[i]);
  if (names.size() > kMostListed) text += " and " + std::to_string(names.size() - kMostListed) + " more";
  return text.empty() ? "nothing" : text;
}

/// Every topic with what it carries.
std::string describe(const TopicList& topics) {
  std::vector<std::string> all;
  for (const auto& [name, topic] : topics)
    all.push_back(name + " (" + (topic.encoding.empty() ? topic.type : topic.encoding) + ")");
  return listed(all);
}

bool isDepth(const Topic& topic) {
  return topic.content == Content::Image && (isCounts(topic.encoding) || isMetres(topic.encoding));
}

std::string descriptionOf(const BagFile& bag) {
  return bag.path().filename().string() + ".toml";
}

constexpr const char* kDecompress =
    "; record what 'rosrun image_transport republish compressedDepth in:=TOPIC raw out:=OTHER' sends";

std::string statedDepth(const BagFile& bag, const TopicList& topics, const std::string& name) {
  const std::string file = bag.path().string();
  const auto found = topics.find(name);
  if (found == topics.end())
    throw InputError(file,
                     "holds no messages of depth_topic " + quoted(name) + "; it holds " + describe(topics));
  if (isDepth(found->second)) return name;
  if (found->second.content == Content::CompressedImage)
    throw InputError(file, "depth_topic " + quoted(name) + " is compressed" + kDecompress);
  throw InputError(file,
                   "depth_topic " + quoted(name) + " holds no depth but " +
                       quoted(found->second.encoding.empty() ? found->second.type : found->second.encoding) +
                       "; images of 16UC1, mono16 or 32FC1 are wanted");
}

std::string onlyDepth(const BagFile& bag, const TopicList& topics) {
  const std::string file = bag.path().string();
  const auto depth = namesOf(topics, [](const auto&, const Topic& topic) { return isDepth(topic); });
  if (depth.size() == 1) return depth.front();
  if (depth.size() > 1)
    throw InputError(file, "holds several depth topics: " + listed(depth) + "; choose one in " +
                               descriptionOf(bag) + " beside it: depth_topic = \"TOPIC\"");
  const auto compressed = namesOf(topics, [](const std::string& name, const Topic& topic) {
    return topic.content == Content::CompressedImage && name.find("epth") != std::string::npos;
  });
  if (!compressed.empty())
    throw InputError(file,
                     "holds depth only in compressed images (" + listed(compressed) + ")" + kDecompress);
  throw InputError(file, "holds no depth images (sensor_msgs/Image of 16UC1, mono16 or 32FC1); it holds " +
                             describe(topics));
}

std::string cameraInfo(const BagFile& bag, const TopicList& topics, const std::string& depth,
                       const std::optional<std::string>& stated) {
  const std::string name = stated.value_or(depth.substr(0, depth.rfind('/') + 1) + "camera_info");
  const auto found = topics.find(name);
  if (found != topics.end() && found->second.content == Content::CameraInfo) return name;
  const auto there =
      namesOf(topics, [](const auto&, const Topic& topic) { return topic.content == Content::CameraInfo; });
  throw InputError(bag.path().string(),
                   "holds no camera_info " + quoted(name) + ", only " + listed(there) + "; state one in " +
                       descriptionOf(bag) +
                       " beside it: camera_info_topic = \"TOPIC\", or [camera] with fx, fy, "
                       "cx, cy");
}

}  // namespace

bool isCounts(const std::string& encoding) {
  return encoding == "16UC1" || encoding == "mono16";
}

bool isMetres(const std::string& encoding) {
  return encoding == "32FC1";
}

Topics chooseTopics(const BagFile& bag, const dataset::Description& description) {
  const TopicList topics = listTopics(bag);
  Topics chosen;
  chosen.depth =
      description.depth_topic ? statedDepth(bag, topics, *description.depth_topic) : onlyDepth(bag, topics);
  if (!description.camera && !description.intrinsics_file)
    chosen.camera_info = cameraInfo(bag, topics, chosen.depth, description.camera_info_topic);
  return chosen;
}

std::vector<MessagePlace> messagesOf(const BagFile& bag, const std::string& topic) {
  std::vector<MessagePlace> places;
  for (const Connection& connection : bag.connections())
    if (connection.topic == topic)
      places.insert(places.end(), connection.messages.begin(), connection.messages.end());
  std::ranges::stable_sort(places, {}, &MessagePlace::time_ns);
  return places;
}

}  // namespace vantage::bag
