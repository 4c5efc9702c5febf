#pragma once

#include <functional>
#include <optional>
#include <string>
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

/// Compresses `content` under its name. \throws std::runtime_error if it is larger than kMaxProductBytes.
StoredProduct storeProduct(const std::string& stage, const std::string& name, int step, const Bytes& content);

/// The content of a product. Sizes are checked before anything is allocated.
/// \throws DamagedBytes if the checksum, the size, or the name inside differ.
Bytes openProduct(const StoredProduct& product, int step);

/// All products of a record, under `step`; those of a closing record have the stage "closing". The first is
/// the record itself with its scalars and the names of the others.
std::vector<StoredProduct> storeRecord(const StepRecord& record, int step);

/// Finds a product by stage and name. \throws DamagedBytes if it is not there.
using FetchProduct = std::function<StoredProduct(const std::string& stage, const std::string& name)>;

/// The record back from its products; realised_voxels is left empty. \throws DamagedBytes
StepRecord openRecord(int step, bool closing, const FetchProduct& fetch, RunDetail detail);

/// Bricks of a step, chunk by chunk. \throws DamagedBytes
void openBricks(int step, bool closing, const FetchProduct& fetch,
                const std::function<void(std::vector<TsdfBrick>)>& take);

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
