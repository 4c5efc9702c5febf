#pragma once

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/exploration/step_record.h"
#include "io/run_bytes.h"
#include "io/run_file.h"

namespace vantage {

/// A product as it lies in a run file: zstd with a checksum over content that begins with its own name and
/// step.
struct StoredProduct {
  std::string stage, name;
  std::uint64_t raw_bytes = 0;  ///< before compression
  Bytes data;
};

/// Largest product that is written or read, bytes before compression.
inline constexpr std::uint64_t kMaxProductBytes = std::uint64_t{1} << 30;

/// A writer for the content of a product; storeProduct() takes it back.
class ProductWriter : public ByteWriter {
 public:
  ProductWriter(std::string stage, std::string name, int step);
  const std::string& stage() const { return stage_; }
  const std::string& name() const { return name_; }

 private:
  std::string stage_, name_;
};

/// Compresses a product. \throws std::runtime_error if it is larger than kMaxProductBytes.
StoredProduct storeProduct(const ProductWriter& content);

/// A product that is one value.
template <class T>
StoredProduct storeValue(const std::string& stage, const std::string& name, int step, const T& value) {
  ProductWriter content(stage, name, step);
  content(value);
  return storeProduct(content);
}

/// A product's bytes and where its content begins in them.
struct OpenedProduct {
  Bytes bytes;
  std::size_t begin = 0;
  ByteReader reader() const { return ByteReader(std::span(bytes).subspan(begin)); }
};

/// Decompresses a product. Sizes are checked before anything is allocated.
/// \throws DamagedBytes if the checksum, the size, or the name inside differ.
OpenedProduct openProduct(const StoredProduct& product, int step);

/// A product that is one value. \throws DamagedBytes
template <class T>
T openValue(const StoredProduct& product, int step) {
  const OpenedProduct opened = openProduct(product, step);
  ByteReader reader = opened.reader();
  T value;
  reader(value);
  reader.requireEnd();
  return value;
}

/// All products of a record, under `step`; those of a closing record have the stage "closing". The first is
/// the record itself with its scalars and the names of the others.
std::vector<StoredProduct> storeRecord(const StepRecord& record, int step);

/// Finds a product by stage and name. \throws DamagedBytes if it is not there.
using FetchProduct = std::function<StoredProduct(const std::string& stage, const std::string& name)>;

/// The record back from its products; realised_voxels is left empty. \throws DamagedBytes
StepRecord openRecord(int step, bool closing, const FetchProduct& fetch, RunDetail detail);

/// Voxels of a brick of either map.
inline const std::vector<TsdfVoxel>& contentOf(const TsdfBrick& brick) {
  return brick.voxels;
}
inline const std::vector<float>& contentOf(const OctreeBrick& brick) {
  return brick.log_odds;
}
template <class Brick>
using BrickVoxel =
    typename std::remove_cvref_t<decltype(contentOf(std::declval<const Brick&>()))>::value_type;

/// Names of the products with the bricks of one of the maps of a step, TsdfBrick or OctreeBrick.
/// \throws DamagedBytes
template <class Brick>
std::vector<std::string> brickChunks(int step, bool closing, const FetchProduct& fetch);

/// Stage under which the bricks of a step lie.
std::string bricksStage(bool closing);

/// One product with bricks, opened: which they are, and their voxels on request. Several threads may read.
template <class Brick>
class BrickChunk {
 public:
  /// \throws DamagedBytes
  explicit BrickChunk(OpenedProduct opened);
  std::span<const std::uint32_t> bricks() const { return bricks_; }
  std::size_t voxels(std::size_t i) const { return begin_[i + 1] - begin_[i]; }
  /// Voxels of the i-th brick. \pre as many fit
  void read(std::size_t i, BrickVoxel<Brick>* voxels) const;

 private:
  OpenedProduct opened_;
  std::vector<std::uint32_t> bricks_;
  std::vector<std::size_t> begin_;  ///< of each brick in the planes, and the end
  std::size_t planes_ = 0;          ///< where they begin in the product
};

/// Names under which a record's scalars, and the realised gain that comes later, are stored.
inline constexpr const char* kRecordStage = "record";
inline constexpr const char* kClosingStage = "closing";
inline constexpr const char* kRecordName = "record";
inline constexpr const char* kRealisedStage = "motion";
inline constexpr const char* kRealisedName = "realised";

/// What becomes known of a step only after it was stored.
struct Realised {
  Stage stage = Stage::Realised;
  std::optional<std::uint64_t> voxels;
  std::optional<ScanPose> served;
};
StoredProduct storeRealised(const Realised& realised, int step);
Realised openRealised(const StoredProduct& product, int step);  ///< \throws DamagedBytes

}  // namespace vantage
