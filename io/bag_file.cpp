#include "io/bag_file.h"

#include <bzlib.h>
#include <lz4frame.h>

#include <cstring>
#include <optional>

namespace vantage::bag {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "#ROSBAG V";
constexpr std::string_view kFormat = "#ROSBAG V2.0\n";
constexpr std::uint32_t kLargestHeader = 1u << 20;
constexpr std::uint32_t kLargestDescription = 16u << 20;  // of a connection: holds the message's definition
constexpr std::uint32_t kLargestChunk = 512u << 20;       // one image of 8192x8192 and then some
constexpr std::uint32_t kIndexEntry = 12;                 // seconds, nanoseconds, offset

/// What a record is, `op` in its header.
enum class Op : std::uint8_t { Message = 2, File = 3, Index = 4, Chunk = 5, ChunkInfo = 6, Connection = 7 };

std::uint32_t number(std::span<const std::uint8_t> bytes) {
  std::uint32_t value = 0;  // bags are little-endian, and so are the machines that this runs on
  std::memcpy(&value, bytes.data(), sizeof(value));
  return value;
}

/// "name=value" entries, each behind its length; nothing if they are not that.
template <typename Fields>
std::optional<Fields> parseFields(std::span<const std::uint8_t> bytes) {
  Fields fields;
  while (!bytes.empty()) {
    if (bytes.size() < 4) return std::nullopt;
    const std::uint32_t length = number(bytes);
    bytes = bytes.subspan(4);
    if (length > bytes.size()) return std::nullopt;
    const std::string entry(reinterpret_cast<const char*>(bytes.data()), length);
    bytes = bytes.subspan(length);
    const std::size_t equals = entry.find('=');
    if (equals == std::string::npos || equals == 0) return std::nullopt;
    fields[entry.substr(0, equals)] = entry.substr(equals + 1);
  }
  return fields;
}

template <typename T, typename Fields>
std::optional<T> value(const Fields& fields, std::string_view name) {
  const auto field = fields.find(name);
  if (field == fields.end() || field->second.size() != sizeof(T)) return std::nullopt;
  T result;
  std::memcpy(&result, field->second.data(), sizeof(T));
  return result;
}

template <typename Fields>
std::string text(const Fields& fields, std::string_view name) {
  const auto field = fields.find(name);
  return field == fields.end() ? std::string() : field->second;
}

/// \return false if the bytes are not one whole LZ4 frame of this size
bool unpackLz4(std::span<const std::uint8_t> packed, std::vector<std::uint8_t>& unpacked) {
  LZ4F_dctx* state = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&state, LZ4F_VERSION))) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> owner(
      state, LZ4F_freeDecompressionContext);
  std::size_t read = 0, written = 0, left = 1;
  while (left > 0) {
    std::size_t in = packed.size() - read, out = unpacked.size() - written;
    left = LZ4F_decompress(state, unpacked.data() + written, &out, packed.data() + read, &in, nullptr);
    if (LZ4F_isError(left) || (left > 0 && in == 0 && out == 0)) return false;
    read += in;
    written += out;
  }
  return written == unpacked.size();
}

bool unpackBz2(std::span<const std::uint8_t> packed, std::vector<std::uint8_t>& unpacked) {
  auto size = static_cast<unsigned>(unpacked.size());
  auto* source = reinterpret_cast<char*>(const_cast<std::uint8_t*>(packed.data()));  // not written to
  const int result = BZ2_bzBuffToBuffDecompress(reinterpret_cast<char*>(unpacked.data()), &size, source,
                                                static_cast<unsigned>(packed.size()), 0, 0);
  return result == BZ_OK && size == unpacked.size();
}

}  // namespace

/// What the index says while it is read: connections follow the chunks that hold their messages.
struct BagFile::Index {
  std::optional<std::uint32_t> chunk_count;  ///< as the file's header states
  std::map<std::uint32_t, Connection> connections;
  std::map<std::uint32_t, std::vector<MessagePlace>> messages;
};

BagFile::BagFile(const fs::path& path) : path_(path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    throw InputError(path.string(), fs::exists(path, error) ? "is not a regular file; a bag of ROS 1 is one"
                                                            : "cannot be read; check that the file exists");
  size_ = fs::file_size(path, error);
  file_.open(path, std::ios::binary);
  if (!file_ || error) throw InputError(path.string(), "cannot be read; check its permissions");
  const auto head = bytesAt(0, std::min<std::uint64_t>(size_, kFormat.size()));
  const std::string_view start(reinterpret_cast<const char*>(head.data()), head.size());
  if (!start.starts_with(kMagic)) throw InputError(path.string(), "is not a bag of ROS 1");
  if (start != kFormat)
    throw InputError(path.string(), "is a bag of another format than 2.0; rosbag fix writes one of 2.0");

  Index index;
  for (std::uint64_t at = kFormat.size(); at < size_;) at = readRecord(at, index);
  if (!index.chunk_count || *index.chunk_count != chunks_.size()) refuseCutOff();
  for (auto& [id, messages] : index.messages) {
    const auto connection = index.connections.find(id);
    if (connection == index.connections.end()) refuseCutOff();
    connection->second.messages = std::move(messages);
  }
  for (auto& [id, connection] : index.connections) connections_.push_back(std::move(connection));
}

void BagFile::refuse(std::uint64_t at, const std::string& what) const {
  throw InputError(path_.string(), "is damaged at byte " + std::to_string(at) + ": " + what +
                                       "; rosbag reindex may repair it");
}

void BagFile::refuseCutOff() const {
  throw InputError(path_.string(), "is cut off or was not closed; repair it with rosbag reindex");
}

std::vector<std::uint8_t> BagFile::bytesAt(std::uint64_t at, std::uint64_t size) const {
  if (at > size_ || size > size_ - at) refuseCutOff();
  std::vector<std::uint8_t> bytes(size);
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(at));
  file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!file_) throw InputError(path_.string(), "cannot be read any more; was it replaced?");
  return bytes;
}

std::uint32_t BagFile::numberAt(std::uint64_t at) const {
  return number(bytesAt(at, 4));
}

/// \return where the next one begins
std::uint64_t BagFile::readRecord(std::uint64_t at, Index& index) {
  const std::uint32_t header_size = numberAt(at);
  if (header_size > size_) refuseCutOff();
  if (header_size > kLargestHeader) refuse(at, "a record's header is too large");
  const auto fields = parseFields<Fields>(bytesAt(at + 4, header_size));
  const auto op = fields ? value<std::uint8_t>(*fields, "op") : std::nullopt;
  if (!op) refuse(at, "no record begins there");
  const std::uint64_t data_at = at + 8 + header_size;
  const std::uint32_t data_size = numberAt(data_at - 4);
  if (!index.chunk_count && static_cast<Op>(*op) != Op::File) refuse(at, "the file's header is missing");
  if (static_cast<Op>(*op) == Op::File) readFileHeader(*fields, index);
  if (data_size > size_ - data_at) refuseCutOff();
  if (static_cast<Op>(*op) == Op::Connection) readConnection(*fields, data_at, data_size, index);
  if (static_cast<Op>(*op) == Op::Index) readIndexData(*fields, data_at, data_size, index);
  if (static_cast<Op>(*op) == Op::Chunk) {
    const auto size = value<std::uint32_t>(*fields, "size");
    if (!size) refuse(at, "a chunk does not state its size");
    chunks_.push_back({data_at, data_size, *size, text(*fields, "compression")});
  }
  return data_at + data_size;
}

void BagFile::readFileHeader(const Fields& fields, Index& index) const {
  if (!text(fields, "encryptor").empty())
    throw InputError(path_.string(), "is encrypted; rosbag decrypt writes a readable one");
  const auto index_at = value<std::uint64_t>(fields, "index_pos");
  if (index_at == 0u)
    throw InputError(path_.string(),
                     "has no index, its recording was not ended; repair it with rosbag reindex");
  if (!index_at || *index_at > size_) refuseCutOff();
  index.chunk_count = value<std::uint32_t>(fields, "chunk_count");
}

void BagFile::readConnection(const Fields& fields, std::uint64_t at, std::uint32_t size, Index& index) const {
  const auto id = value<std::uint32_t>(fields, "conn");
  if (!id || size > kLargestDescription) refuse(at, "a connection cannot be read");
  const auto description = parseFields<Fields>(bytesAt(at, size));
  if (!description) refuse(at, "a connection cannot be read");
  index.connections[*id] = {
      text(fields, "topic"), text(*description, "type"), text(*description, "md5sum"), {}};
}

void BagFile::readIndexData(const Fields& fields, std::uint64_t at, std::uint32_t size, Index& index) const {
  const auto id = value<std::uint32_t>(fields, "conn"), count = value<std::uint32_t>(fields, "count");
  if (!id || !count || size != static_cast<std::uint64_t>(*count) * kIndexEntry || chunks_.empty())
    refuse(at, "an index does not fit its messages");
  const auto bytes = bytesAt(at, size);
  std::vector<MessagePlace>& messages = index.messages[*id];
  for (std::span<const std::uint8_t> left(bytes); !left.empty(); left = left.subspan(kIndexEntry)) {
    const std::uint64_t time_ns = number(left) * 1'000'000'000ull + number(left.subspan(4));
    messages.push_back({time_ns, static_cast<std::uint32_t>(chunks_.size() - 1), number(left.subspan(8))});
  }
}

std::shared_ptr<const std::vector<std::uint8_t>> BagFile::unpack(const Chunk& chunk) const {
  if (chunk.size > kLargestChunk) refuse(chunk.at, "a chunk of more than 512 MiB");
  std::vector<std::uint8_t> packed = bytesAt(chunk.at, chunk.packed_size);
  if (chunk.compression == "none") return std::make_shared<std::vector<std::uint8_t>>(std::move(packed));
  auto unpacked = std::make_shared<std::vector<std::uint8_t>>(chunk.size);
  bool whole = false;
  if (chunk.compression == "lz4")
    whole = unpackLz4(packed, *unpacked);
  else if (chunk.compression == "bz2")
    whole = unpackBz2(packed, *unpacked);
  else
    refuse(chunk.at, "a chunk is packed in an unknown way; none, lz4 and bz2 are known");
  if (!whole) refuse(chunk.at, "a chunk cannot be unpacked");
  return unpacked;
}

Message BagFile::read(const MessagePlace& place) const {
  const Chunk& chunk = chunks_.at(place.chunk);
  std::shared_ptr<const std::vector<std::uint8_t>> unpacked;
  {
    const std::lock_guard lock(mutex_);
    if (!last_chunk_ || last_number_ != place.chunk) {
      last_chunk_ = unpack(chunk);
      last_number_ = place.chunk;
    }
    unpacked = last_chunk_;
  }
  std::span<const std::uint8_t> left(*unpacked);
  const auto take = [&](std::size_t size) {
    if (size > left.size()) refuse(chunk.at, "a message reaches beyond its chunk");
    const auto taken = left.first(size);
    left = left.subspan(size);
    return taken;
  };
  take(place.offset);
  for (;;) {  // a connection may be announced before its first message
    const auto fields = parseFields<Fields>(take(number(take(4))));
    const auto op = fields ? value<std::uint8_t>(*fields, "op") : std::nullopt;
    const auto data = take(number(take(4)));
    if (op == static_cast<std::uint8_t>(Op::Message)) return {unpacked, data};
    if (op != static_cast<std::uint8_t>(Op::Connection))
      refuse(chunk.at, "no message lies where its index says");
  }
}

}  // namespace vantage::bag
