#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/bag_messages.h"
#include "io/dataset.h"

namespace vantage::bag {

/// The depth images of one topic, read when asked for; their numbers count from 0 in ascending time.
class DepthTopic : public DepthSource {
 public:
  /// \throws InputError for more than 200000 images
  DepthTopic(std::shared_ptr<const BagFile> bag, std::string topic);

  /// By frame number.
  const std::vector<MessagePlace>& places() const { return places_; }

  /// Checks what an image says about itself; number 0 comes first, and all are like it.
  /// \throws InputError naming file, number and topic: of another size or encoding, no depth, big-endian,
  /// data that does not fit
  Image open(std::size_t number, const Message& message);

  /// Of all images, once one was opened.
  const ImageSize& size() const { return kind_.size; }
  const std::string& encoding() const { return kind_.encoding; }

  DepthImage load(int number, const DepthPngFormat& format) const override;

 private:
  struct Kind {
    ImageSize size;
    std::string encoding;
    bool operator==(const Kind&) const = default;
  };
  Kind kindOf(std::size_t number, const Image& image) const;
  void requireKind(std::size_t number, const Kind& kind) const;
  [[noreturn]] void refuse(std::size_t number, const std::string& what) const;

  std::shared_ptr<const BagFile> bag_;
  std::string topic_;
  std::vector<MessagePlace> places_;
  Kind kind_;  ///< of the first image
};

}  // namespace vantage::bag
