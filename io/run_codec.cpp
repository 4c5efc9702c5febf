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

/// How the products with the bricks of a map begin.
template <class Brick>
constexpr const char* kBricksName = "bricks.";
template <>
constexpr const char* kBricksName<OctreeBrick> = "octree.";

std::vector<TsdfVoxel>& contentOf(TsdfBrick& brick) {
  return brick.voxels;
}
std::vector<float>& contentOf(OctreeBrick& brick) {
  return brick.log_odds;
}
using vantage::contentOf;

template <class Brick>
StoredProduct storeChunk(std::span<const Brick> bricks, ProductWriter content) {
  constexpr std::size_t kBytes = sizeof(BrickVoxel<Brick>);
  std::vector<std::uint32_t> index;
  std::vector<std::uint16_t> sizes;
  std::size_t total = 0;
  for (const Brick& brick : bricks) {
    const std::size_t voxels = contentOf(brick).size();
    if (voxels > kBrickVoxels)
      throw std::invalid_argument("changed bricks: a brick has " + std::to_string(voxels) +
                                  " voxels; allowed: 0 .. " + std::to_string(kBrickVoxels));
    index.push_back(brick.brick);
    sizes.push_back(static_cast<std::uint16_t>(voxels));
    total += voxels;
  }
  content.reserve(total * kBytes + bricks.size() * 6 + 128);
  content(index, sizes);
  std::uint8_t* planes = content.append(total * kBytes);
  for (const Brick& brick : bricks) {
    const auto& voxels = contentOf(brick);
    toPlanes(reinterpret_cast<const std::uint8_t*>(voxels.data()), planes, voxels.size(), kBytes, total);
    planes += voxels.size();
  }
  return storeProduct(content);
}

/// All bricks of a product.
template <class Brick>
void appendChunk(const BrickChunk<Brick>& chunk, std::vector<Brick>& bricks) {
  for (std::size_t i = 0; i < chunk.bricks().size(); ++i) {
    Brick& brick = bricks.emplace_back();
    brick.brick = chunk.bricks()[i];
    contentOf(brick).resize(chunk.voxels(i));
    chunk.read(i, contentOf(brick).data());
  }
}

template <class Brick>
std::string chunkName(std::size_t chunk) {
  std::string number = std::to_string(chunk);
  return kBricksName<Brick> + std::string(number.size() < 4 ? 4 - number.size() : 0, '0') + number;
}

/// Chunks are compressed side by side; each fills its own slot.
template <class Brick>
std::vector<StoredProduct> storeBricks(const std::string& stage, int step, const std::vector<Brick>& bricks) {
  const std::size_t chunks =
      std::max<std::size_t>(1, (bricks.size() + kBricksPerChunk - 1) / kBricksPerChunk);
  std::vector<StoredProduct> stored(chunks);
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
    const std::size_t first = c * kBricksPerChunk;
    const std::span all(bricks);
    const auto part = all.subspan(first, std::min(kBricksPerChunk, all.size() - first));
    stored[c] = storeChunk<Brick>(part, ProductWriter(stage, chunkName<Brick>(c), step));
  });
  return stored;
}

/// The first product of a record.
struct RecordContent {
  StepRecord record;
  std::vector<std::string> products;  ///< names of the others, to notice one that is lost
};

template <class Brick>
bool isBricks(const std::string& name) {
  return name.starts_with(kBricksName<Brick>);
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
  if (r.utilities)
    for (const std::uint32_t n : r.utilities->ranking)
      require(n < r.utilities->views.size(), "a ranked view that was not evaluated");
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
  const ContourChosenView& chosen = *r.search->chosen;
  require(chosen.search < r.search->segments.size(), "a chosen view without its segment");
  require(chosen.rank < r.search->segments[chosen.search].scores.size(), "a chosen view without its score");
  require(chosen.contour_point < points, "a chosen view without its contour point");
}

/// One state for each frame, and complete trajectories.
void checkJoints(const StepRecord& r) {
  if (r.joints) require(r.joints->size() == r.scan.size(), "joints of another number of frames");
  if (!r.trajectory) return;
  const JointTrajectory& t = *r.trajectory;
  require(t.size() > 0 && t.positions.size() == t.size() && t.velocities.size() == t.size(),
          "a trajectory with too few points");
  for (const JointVector& q : t.positions)
    require(q.size() == t.positions.front().size(), "a trajectory with too few joints");
}

void checkDepth(const DepthImage& d) {
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
  add("sense", "filtered", record.filtered);
  add("sense", "joints", record.joints);
  const auto addBricks = [&](const auto& bricks) {
    if (!bricks) return;
    for (StoredProduct& chunk : storeBricks(stageOf("fuse"), step, *bricks)) all.push_back(std::move(chunk));
  };
  addBricks(record.changed_bricks);
  addBricks(record.changed_octree_bricks);
  add("fuse", "box", record.box);
  add("contours", "contours", record.contours);
  add("surface", "surface", record.surface);
  add("segmentation", "labels", record.labels);
  add("saliency", "saliency", record.saliency);
  add("generation", "point_labels", record.point_labels);
  add("generation", "positions", record.positions);
  add("evaluation", "search", record.search);
  add("evaluation", "utilities", record.utilities);
  add("motion", "trajectory", record.trajectory);

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
  take("sense", "filtered", record.filtered);
  take("sense", "joints", record.joints);
  take("contours", "contours", record.contours);
  take("surface", "surface", record.surface);
  take("segmentation", "labels", record.labels);
  take("saliency", "saliency", record.saliency);
  take("generation", "point_labels", record.point_labels);
  take("generation", "positions", record.positions);
  take("evaluation", "search", record.search);
  take("evaluation", "utilities", record.utilities);
  take("motion", "trajectory", record.trajectory);
  take("fuse", "box", record.box);
  if (record.depth) checkDepth(record.depth->depth);
  if (record.filtered) {
    checkDepth(record.filtered->depth);
    require(record.filtered->mask.size() == record.filtered->depth.depth_m.size(), "a mask of another size");
  }
  checkIndices(record);
  checkJoints(record);

  const auto takeBricks = [&]<class Brick>(std::shared_ptr<const std::vector<Brick>>& bricks) {
    if (std::ranges::none_of(content.products, isBricks<Brick>)) return;
    auto all = std::make_shared<std::vector<Brick>>();
    for (const std::string& name : content.products)
      if (isBricks<Brick>(name))
        appendChunk(BrickChunk<Brick>(openProduct(fetch(bricksStage(closing), name), step)), *all);
    bricks = std::move(all);
  };
  if (detail == RunDetail::All) {
    takeBricks(record.changed_bricks);
    takeBricks(record.changed_octree_bricks);
  }
  return record;
}

std::string bricksStage(bool closing) {
  return closing ? kClosingStage : "fuse";
}

template <class Brick>
std::vector<std::string> brickChunks(int step, bool closing, const FetchProduct& fetch) {
  std::vector<std::string> names = openContent(step, closing, fetch).products;
  std::erase_if(names, [](const std::string& name) { return !isBricks<Brick>(name); });
  return names;
}
template std::vector<std::string> brickChunks<TsdfBrick>(int, bool, const FetchProduct&);
template std::vector<std::string> brickChunks<OctreeBrick>(int, bool, const FetchProduct&);

template <class Brick>
BrickChunk<Brick>::BrickChunk(OpenedProduct opened) : opened_(std::move(opened)), begin_(1, 0) {
  ByteReader reader = opened_.reader();
  std::vector<std::uint16_t> sizes;
  reader(bricks_, sizes);
  if (bricks_.size() != sizes.size()) throw DamagedBytes("bricks without a size");
  for (const std::uint16_t size : sizes) begin_.push_back(begin_.back() + size);
  planes_ = opened_.bytes.size() - reader.remaining();
  reader.raw(begin_.back() * sizeof(BrickVoxel<Brick>));
  reader.requireEnd();
}

template <class Brick>
void BrickChunk<Brick>::read(std::size_t i, BrickVoxel<Brick>* to) const {
  fromPlanes(opened_.bytes.data() + planes_ + begin_[i], reinterpret_cast<std::uint8_t*>(to), voxels(i),
             sizeof(BrickVoxel<Brick>), begin_.back());
}

template class BrickChunk<TsdfBrick>;
template class BrickChunk<OctreeBrick>;

}  // namespace vantage
