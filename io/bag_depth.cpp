#include "io/bag_depth.h"

#include <cstring>
#include <utility>

#include "io/bag_topics.h"

namespace vantage::bag {
namespace {

constexpr std::uint32_t kLargestSide = 8192;
constexpr std::size_t kMostFrames = 200000;

std::string text(const ImageSize& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

/// Without what rows hold behind their pixels.
template <typename T>
std::vector<T> pixels(const Image& image) {
  std::vector<T> values(static_cast<std::size_t>(image.width) * image.height);
  for (std::size_t v = 0; v < image.height; ++v)
    std::memcpy(&values[v * image.width], &image.data[v * image.step], image.width * sizeof(T));
  return values;
}

DepthImage depthOfMetres(ImageSize size, const std::vector<float>& values, const DepthPngFormat& format) {
  DepthImage depth(size.width, size.height);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (DepthImage::valid(values[i])) depth.depth_m[i] = static_cast<float>(values[i] * format.unit_m);
  return depth;
}

}  // namespace

DepthTopic::DepthTopic(std::shared_ptr<const BagFile> bag, std::string topic)
    : bag_(std::move(bag)), topic_(std::move(topic)), places_(messagesOf(*bag_, topic_)) {
  if (places_.size() > kMostFrames) throw InputError(bag_->path().string(), "more than 200000 frames");
}

Image DepthTopic::open(std::size_t number, const Message& message) {
  const Image image = parseImage(*bag_, message);
  const Kind kind = kindOf(number, image);
  if (number == 0) kind_ = kind;
  requireKind(number, kind);
  return image;
}

DepthImage DepthTopic::load(int number, const DepthPngFormat& format) const {
  const Message message = bag_->read(places_.at(static_cast<std::size_t>(number)));
  const Image image = parseImage(*bag_, message);
  const Kind kind = kindOf(number, image);
  requireKind(number, kind);
  return isCounts(kind.encoding) ? depthOfCounts(kind.size, pixels<std::uint16_t>(image), format)
                                 : depthOfMetres(kind.size, pixels<float>(image), format);
}

DepthTopic::Kind DepthTopic::kindOf(std::size_t number, const Image& image) const {
  const Kind kind{{static_cast<int>(image.width), static_cast<int>(image.height)}, image.encoding};
  if (image.width < 1 || image.height < 1 || image.width > kLargestSide || image.height > kLargestSide)
    refuse(number, "is " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                       "; allowed: 1x1 .. 8192x8192");
  if (!isCounts(image.encoding) && !isMetres(image.encoding))
    refuse(number, "is of encoding " + quoted(image.encoding) + "; 16UC1, mono16 or 32FC1 is wanted");
  if (image.big_endian) refuse(number, "is big-endian; little-endian images are wanted");
  const std::uint64_t row = std::uint64_t{image.width} * (isCounts(image.encoding) ? 2 : 4);
  if (image.step < row || image.data.size() != std::uint64_t{image.step} * image.height)
    refuse(number, "holds " + std::to_string(image.data.size()) + " bytes in rows of " +
                       std::to_string(image.step) + ", which does not fit " + text(kind.size) +
                       " pixels of " + image.encoding);
  return kind;
}

void DepthTopic::requireKind(std::size_t number, const Kind& kind) const {
  if (kind == kind_) return;
  refuse(number, "is " + text(kind.size) + " of " + kind.encoding + "; the first is " + text(kind_.size) +
                     " of " + kind_.encoding + ", all must be alike");
}

void DepthTopic::refuse(std::size_t number, const std::string& what) const {
  throw InputError(bag_->path().string(),
                   "image " + std::to_string(number) + " of " + quoted(topic_) + " " + what);
}

}  // namespace vantage::bag
