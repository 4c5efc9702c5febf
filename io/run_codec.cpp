#include "io/run_codec.h"

#include <tbb/parallel_for.h>
#include <zstd.h>

#include <algorithm>
#include <exception>
#include <memory>

#include "io/run_fields.h"

namespace vantage {
namespace {

constexpr int kLevel = 1;  // zstd; byte planes leave higher levels little to gain
constexpr std::size_t kBricksPerChunk = 4096;
constexpr std::size_t kBrickVoxels = std::size_t{kBrickX} * kBrickY * kBrickZ;

using Context = std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)>;

Bytes compress(const Bytes& raw) {
  const Context context(ZSTD_createCCtx(), &ZSTD_freeCCtx);
  if (!context) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  const std::size_t bound = ZSTD_compressBound(raw.size());
  const auto data = std::make_unique_for_overwrite<std::uint8_t[]>(bound);
  const std::size_t size = ZSTD_compress2(context.get(), data.get(), bound, raw.data(), raw.size());
  if (ZSTD_isError(size)) throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(size));
  return Bytes(data.get(), data.get() + size);
}

StoredProduct storeChunk(std::span<const TsdfBrick> bricks, ProductWriter content) {
  std::vector<std::uint32_t> index;
  std::vector<std::uint16_t> sizes;
  std::size_t total = 0;
  for (const TsdfBrick& brick : bricks) {
    if (brick.voxels.size() > kBrickVoxels)
      throw std::invalid_argument("changed_bricks: a brick has " + std::to_string(brick.voxels.size()) +
                                  " voxels; allowed: 0 .. " + std::to_string(kBrickVoxels));
    index.push_back(brick.brick);
    sizes.push_back(static_cast<std::uint16_t>(brick.voxels.size()));
    total += brick.voxels.size();
  }
  content.reserve(total * sizeof(TsdfVoxel) + bricks.size() * 6 + 128);
  content(index, sizes);
  std::uint8_t* planes = content.append(total * sizeof(TsdfVoxel));
  for (const TsdfBrick& brick : bricks) {
    toPlanes(reinterpret_cast<const std::uint8_t*>(brick.voxels.data()), planes, brick.voxels.size(),
             sizeof(TsdfVoxel), total);
    planes += brick.voxels.size();
  }
  return storeProduct(content);
}

std::vector<TsdfBrick> openChunk(const OpenedProduct& opened) {
  ByteReader reader = opened.reader();
  std::vector<std::uint32_t> index;
  std::vector<std::uint16_t> sizes;
  reader(index, sizes);
  if (index.size() != sizes.size()) throw DamagedBytes("bricks without a size");
  std::size_t total = 0;
  for (const std::uint16_t size : sizes) total += size;
  const std::uint8_t* planes = reader.raw(total * sizeof(TsdfVoxel)).data();
  reader.requireEnd();
  std::vector<TsdfBrick> bricks(index.size());
  for (std::size_t i = 0; i < bricks.size(); ++i) {
    bricks[i].brick = index[i];
    bricks[i].voxels.resize(sizes[i]);
    fromPlanes(planes, reinterpret_cast<std::uint8_t*>(bricks[i].voxels.data()), sizes[i], sizeof(TsdfVoxel),
               total);
    planes += sizes[i];
  }
  return bricks;
}

std::string chunkName(std::size_t chunk) {
  std::string number = std::to_string(chunk);
  return "bricks." + std::string(number.size() < 4 ? 4 - number.size() : 0, '0') + number;
}

/// Chunks are compressed side by side; each fills its own slot.
std::vector<StoredProduct> storeBricks(const std::string& stage, int step,
                                       const std::vector<TsdfBrick>& bricks) {
  const std::size_t chunks =
      std::max<std::size_t>(1, (bricks.size() + kBricksPerChunk - 1) / kBricksPerChunk);
  std::vector<StoredProduct> stored(chunks);
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
    const std::size_t first = c * kBricksPerChunk;
    const std::span all(bricks);
    const auto part = all.subspan(first, std::min(kBricksPerChunk, all.size() - first));
    stored[c] = storeChunk(part, ProductWriter(stage, chunkName(c), step));
  });
  return stored;
}

/// The first product of a record.
struct RecordContent {
  StepRecord record;
  std::vector<std::string> products;  ///< names of the others, to notice one that is lost
};

bool isBricks(const std::string& name) {
  return name.starts_with("bricks.");
}

RecordContent openContent(int step, bool closing, const FetchProduct& fetch) {
  const OpenedProduct opened = openProduct(fetch(closing ? kClosingStage : kRecordStage, kRecordName), step);
  ByteReader reader = opened.reader();
  RecordContent content;
  reader(content.record, content.products);
  reader.requireEnd();
  if (content.record.closing != closing) throw DamagedBytes("a closing record in the place of a step");
  return content;
}

void require(bool good, const char* what) {
  if (!good) throw DamagedBytes(what);
}

/// Indices of one product into another, so that nobody who trusts a record reads past an end.
void checkIndices(const StepRecord& r) {
  const std::size_t points = r.contours ? r.contours->points.size() : 0;
  if (r.contours)
    for (const ContourVoxel& v : r.contours->voxels)
      require(v.group < points, "a contour voxel without its group");
  if (r.surface) {
    const std::size_t count = r.surface->points.size();
    require(r.surface->normals.size() == count || r.surface->normals.empty(),
            "a surface with too few normals");
    for (const auto& t : r.surface->triangles)
      require(t[0] < count && t[1] < count && t[2] < count, "a triangle without its corners");
  }
  if (r.labels)
    for (const std::uint32_t l : r.labels->of_point) require(l <= r.labels->count, "a label beyond the last");
  if (r.positions)
    for (const ViewPosition& p : *r.positions) require(p.group < points, "a view without its contour point");
  if (!r.search) return;
  const std::size_t segments = r.saliency ? r.saliency->segments.size() : 0;
  for (const SegmentSearch& s : r.search->segments) {
    require(s.segment >= -1 && s.segment < static_cast<std::int64_t>(segments),
            "a search without its segment");
    for (const std::uint32_t p : s.contour_points) require(p < points, "a search without its contour points");
    for (const PoseScore& p : s.scores)
      require(p.histogram >= -1 && p.histogram < static_cast<std::int64_t>(s.histograms.size()),
              "a score without its histogram");
  }
  if (!r.search->chosen) return;
  const ChosenView& chosen = *r.search->chosen;
  require(chosen.search < r.search->segments.size(), "a chosen view without its segment");
  require(chosen.rank < r.search->segments[chosen.search].scores.size(), "a chosen view without its score");
}

void checkDepth(const DepthFrame& frame) {
  const DepthImage& d = frame.depth;
  require(d.width >= 0 && d.height >= 0 &&
              static_cast<std::uint64_t>(d.width) * static_cast<std::uint64_t>(d.height) == d.depth_m.size(),
          "a depth image of another size than it says");
}

}  // namespace

ProductWriter::ProductWriter(std::string stage, std::string name, int step)
    : stage_(std::move(stage)), name_(std::move(name)) {
  (*this)(stage_, name_, step);
}

StoredProduct storeProduct(const ProductWriter& content) {
  const std::size_t size = content.bytes().size();
  if (size > kMaxProductBytes)
    throw std::runtime_error(content.stage() + "/" + content.name() + " has " + std::to_string(size) +
                             " bytes; a run file stores at most " + std::to_string(kMaxProductBytes) +
                             " in one product");
  return {content.stage(), content.name(), size, compress(content.bytes())};
}

OpenedProduct openProduct(const StoredProduct& product, int step) {
  // 4 bytes of a frame stand for at most one block of 128 KiB.
  constexpr std::uint64_t kMaxRatio = 32768;
  const std::uint64_t size = ZSTD_getFrameContentSize(product.data.data(), product.data.size());
  if (size != product.raw_bytes || size > kMaxProductBytes || size / kMaxRatio > product.data.size())
    throw DamagedBytes("its size is wrong");
  Bytes raw(size);
  const std::size_t got = ZSTD_decompress(raw.data(), raw.size(), product.data.data(), product.data.size());
  if (ZSTD_isError(got)) throw DamagedBytes(ZSTD_getErrorName(got));
  if (got != size) throw DamagedBytes("it ends too early");

  ByteReader reader(raw);
  std::string stage, name;
  int own_step = 0;
  reader(stage, name, own_step);
  if (stage != product.stage || name != product.name || own_step != step)
    throw DamagedBytes("another product lies in its place");
  const std::size_t begin = raw.size() - reader.remaining();
  return {std::move(raw), begin};
}

std::vector<StoredProduct> storeRecord(const StepRecord& record, int step) {
  std::vector<StoredProduct> all(1);  // the record itself, once the names of the others are known
  const auto stageOf = [&](const char* stage) { return std::string(record.closing ? kClosingStage : stage); };
  const auto add = [&](const char* stage, const char* name, const auto& product) {
    if (product) all.push_back(storeValue(stageOf(stage), name, step, *product));
  };
  add("sense", "depth", record.depth);
  if (record.changed_bricks)
    for (StoredProduct& chunk : storeBricks(stageOf("fuse"), step, *record.changed_bricks))
      all.push_back(std::move(chunk));
  add("contours", "contours", record.contours);
  add("surface", "surface", record.surface);
  add("segmentation", "labels", record.labels);
  add("saliency", "saliency", record.saliency);
  add("generation", "point_labels", record.point_labels);
  add("generation", "positions", record.positions);
  add("evaluation", "search", record.search);

  std::vector<std::string> names;
  for (std::size_t i = 1; i < all.size(); ++i) names.push_back(all[i].name);
  ProductWriter content(stageOf(kRecordStage), kRecordName, step);
  content(record, names);
  all[0] = storeProduct(content);
  return all;
}

StoredProduct storeRealised(const Realised& realised, int step) {
  return storeValue(kRealisedStage, kRealisedName, step, realised);
}

Realised openRealised(const StoredProduct& product, int step) {
  return openValue<Realised>(product, step);
}

StepRecord openRecord(int step, bool closing, const FetchProduct& fetch, RunDetail detail) {
  RecordContent content = openContent(step, closing, fetch);
  StepRecord& record = content.record;
  const auto take = [&](const char* stage, const char* name, auto& product) {
    if (std::ranges::find(content.products, name) == content.products.end()) return;
    using Product = std::remove_const_t<typename std::remove_reference_t<decltype(product)>::element_type>;
    product = std::make_shared<const Product>(
        openValue<Product>(fetch(closing ? kClosingStage : stage, name), step));
  };
  take("sense", "depth", record.depth);
  take("contours", "contours", record.contours);
  take("surface", "surface", record.surface);
  take("segmentation", "labels", record.labels);
  take("saliency", "saliency", record.saliency);
  take("generation", "point_labels", record.point_labels);
  take("generation", "positions", record.positions);
  take("evaluation", "search", record.search);
  if (record.depth) checkDepth(*record.depth);
  checkIndices(record);

  if (detail == RunDetail::All && std::ranges::any_of(content.products, isBricks)) {
    auto bricks = std::make_shared<std::vector<TsdfBrick>>();
    openBricks(step, closing, fetch, [&](std::vector<TsdfBrick> chunk) {
      bricks->insert(bricks->end(), std::move_iterator(chunk.begin()), std::move_iterator(chunk.end()));
    });
    record.changed_bricks = std::move(bricks);
  }
  return record;
}

void openBricks(int step, bool closing, const FetchProduct& fetch,
                const std::function<void(std::vector<TsdfBrick>)>& take) {
  for (const std::string& name : openContent(step, closing, fetch).products)
    if (isBricks(name)) take(openChunk(openProduct(fetch(closing ? kClosingStage : "fuse", name), step)));
}

}  // namespace vantage
