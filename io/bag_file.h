#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "io/error.h"

namespace vantage::bag {

/// Where a message lies.
struct MessagePlace {
  std::uint64_t time_ns = 0;  ///< when it was recorded
  std::uint32_t chunk = 0;    ///< number of the chunk, in file order
  std::uint32_t offset = 0;   ///< in the unpacked chunk, bytes
};

/// What one publisher sent on a topic.
struct Connection {
  std::string topic, type, md5sum;
  std::vector<MessagePlace> messages;  ///< as recorded
};

/// A serialised message; valid for as long as it lives.
struct Message {
  std::shared_ptr<const std::vector<std::uint8_t>> chunk;
  std::span<const std::uint8_t> bytes;  ///< of the chunk
};

/// A recording of ROS 1 (format 2.0), read a chunk at a time. Every size and offset of the file is checked
/// before it is used: rosbag's own reader (1.15) trusts those inside a chunk and crashes on a damaged one.
class BagFile {
 public:
  /// Reads the index. \throws InputError naming the file: missing, no bag, of another format, encrypted,
  /// without an index, cut off or damaged.
  explicit BagFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  const std::vector<Connection>& connections() const { return connections_; }

  /// Safe to call from several threads; the last chunk is kept, so reading in file order is fast.
  /// \throws InputError naming the file if the chunk is damaged, packed in an unknown way, or larger than
  /// 512 MiB.
  Message read(const MessagePlace& place) const;

 private:
  using Fields = std::map<std::string, std::string, std::less<>>;
  struct Chunk {
    std::uint64_t at = 0;  ///< of its data, bytes from the beginning of the file
    std::uint32_t packed_size = 0, size = 0;
    std::string compression;
  };
  struct Index;

  std::vector<std::uint8_t> bytesAt(std::uint64_t at, std::uint64_t size) const;
  std::uint32_t numberAt(std::uint64_t at) const;
  std::uint64_t readRecord(std::uint64_t at, Index& index);
  void readFileHeader(const Fields& fields, Index& index) const;
  void readConnection(const Fields& fields, std::uint64_t at, std::uint32_t size, Index& index) const;
  void readIndexData(const Fields& fields, std::uint64_t at, std::uint32_t size, Index& index) const;
  std::shared_ptr<const std::vector<std::uint8_t>> unpack(const Chunk& chunk) const;
  [[noreturn]] void refuse(std::uint64_t at, const std::string& what) const;
  [[noreturn]] void refuseCutOff() const;

  std::filesystem::path path_;
  std::uint64_t size_ = 0;
  std::vector<Connection> connections_;
  std::vector<Chunk> chunks_;

  mutable std::mutex mutex_;  ///< of what follows
  mutable std::ifstream file_;
  mutable std::shared_ptr<const std::vector<std::uint8_t>> last_chunk_;
  mutable std::uint32_t last_number_ = 0;
};

}  // namespace vantage::bag
