#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <mutex>
#include <stdexcept>

#include "io/error.h"
#include "io/run_codec.h"
#include "io/run_database.h"
#include "io/run_fields.h"
#include "io/run_file.h"
#include "io/run_maps.h"
#include "io/run_schema.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// Largest grid that a header may ask for.
constexpr int kMaxGridSize = 8192;
constexpr std::uint64_t kMaxGridVoxels = std::uint64_t{1} << 32;

/// How the file is to be opened. SQLite's header says whether it is written with a log beside it; a log that
/// is missing means that nobody writes, and opening must not make one.
DatabaseMode modeOf(const fs::path& path) {
  std::array<char, 20> head{};
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), head.size());
  if (file.gcount() < static_cast<std::streamsize>(head.size()) ||
      std::string(head.data(), 15) != "SQLite format 3")
    throw InputError(path.string(),
                     "is not a run file; give a .vantage file that `vantage explore -o` wrote");
  std::error_code ignored;
  const bool log = head[19] == 2 && fs::exists(path.string() + "-wal", ignored);
  return log ? DatabaseMode::Follow : DatabaseMode::Finished;
}

void requireFile(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw InputError(path.string(), "does not exist; check the path");
  if (!fs::is_regular_file(status)) throw InputError(path.string(), "is not a file; give a .vantage file");
  if (!std::ifstream(path)) throw InputError(path.string(), "cannot be read; check its permissions");
}

void checkOctree(const OctreeHeader& octree, const GridGeometry& volume) {
  try {
    octree.map.validate();
    octree.planner.validate();
  } catch (const std::invalid_argument& error) {
    throw DamagedBytes(error.what());
  }
  const Box& box = octree.object_box;
  if (!box.min().allFinite() || !box.max().allFinite() || box.isEmpty())
    throw DamagedBytes("the box of its object is no box");
  if (octree.planner.coarse_levels > maxCoarseLevels(octree.planner.sensor, octree.map.voxel_size_m))
    throw DamagedBytes("its coarse levels do not fit its sensor");
  const Eigen::Vector3d voxels = volume.bounds().sizes() / octree.map.voxel_size_m;
  if (!(voxels.array() <= kMaxGridSize).all() || !(voxels.prod() <= static_cast<double>(kMaxGridVoxels)))
    throw DamagedBytes("its octree has an impossible size");
}

/// Whoever draws the arm trusts its frames.
void checkArm(const RobotModel& arm) {
  if (arm.joints.empty() || arm.jointCount() > kMaxArmJoints)
    throw DamagedBytes("its arm has an impossible number of joints");
  for (const LinkShape& shape : arm.shapes)
    if (shape.frame < -1 || shape.frame >= arm.jointCount())
      throw DamagedBytes("a body of its arm hangs on a joint that is not there");
}

void checkHeader(const RunHeader& h) {
  const Eigen::Vector3i& size = h.volume.size;
  const bool sizes = (size.array() >= 0).all() && (size.array() <= kMaxGridSize).all();
  if (!sizes || h.volume.count() > kMaxGridVoxels) throw DamagedBytes("its volume has an impossible size");
  if (h.octree) checkOctree(*h.octree, h.volume);
  if (h.arm) checkArm(h.arm->model);
  for (const auto& t : h.truth.triangles)
    for (const std::uint32_t corner : t)
      if (corner >= h.truth.vertices.size()) throw DamagedBytes("its true scene lacks corners");
  if (!h.truth.colors.empty() && h.truth.colors.size() != h.truth.triangles.size())
    throw DamagedBytes("its true scene lacks colours");
}

std::vector<int> integers(Database& database, const std::string& sql) {
  std::vector<int> all;
  Statement statement(database, sql);
  while (statement.next()) {
    const std::int64_t value = statement.integer(0);
    if (value < 1 || value > std::numeric_limits<int>::max() - 1)
      throw DamagedBytes("a step has an impossible number");
    all.push_back(static_cast<int>(value));
  }
  return all;
}

std::optional<StoredProduct> findRunProduct(Database& database, const std::string& name) {
  Statement s(database, "SELECT raw_bytes, data FROM run_product WHERE name=?");
  if (!s.bind(name).next()) return {};
  return StoredProduct{"run", name, static_cast<std::uint64_t>(s.integer(0)), s.blob(1)};
}

std::optional<StoredProduct> findProduct(Database& database, int step, const std::string& stage,
                                         const std::string& name) {
  Statement s(database, "SELECT raw_bytes, data FROM product WHERE step=? AND stage=? AND name=?");
  if (!s.bind(step).bind(stage).bind(name).next()) return {};
  return StoredProduct{stage, name, static_cast<std::uint64_t>(s.integer(0)), s.blob(1)};
}

FetchProduct fetchFrom(Database& database, int step) {
  return [&database, step](const std::string& stage, const std::string& name) {
    auto product = findProduct(database, step, stage, name);
    if (!product) throw DamagedBytes(stage + "/" + name + " is missing");
    return std::move(*product);
  };
}

void readContourOptions(Database& database, ContourPlannerConfig& config) {
  constexpr int kFirstVersion = 3;
  const auto stored = findRunProduct(database, "contour options");
  if (!stored && database.number("PRAGMA user_version") >= kFirstVersion)
    throw DamagedBytes("options of its planner are missing");
  if (!stored) return;
  const auto options = openValue<ContourOptions>(*stored, 0);
  config.contours.normal = options.normal;
  config.gain.count = options.count;
}

/// What a run holds.
struct Contents {
  std::vector<int> steps;
  bool closing = false;
  std::optional<std::string> stop_reason;
  int closingStep() const { return steps.empty() ? 1 : steps.back() + 1; }
};

/// Tables, products and the list made at the end must agree. \throws DamagedBytes
Contents readContents(Database& database) {
  Contents contents;
  contents.steps = integers(database, "SELECT step FROM step ORDER BY step");
  const std::string records = "SELECT step FROM product WHERE name='record' AND stage=";
  if (contents.steps != integers(database, records + "'record' ORDER BY step"))
    throw DamagedBytes("its steps and their products differ");
  const std::vector<int> closing = integers(database, "SELECT step FROM closing");
  if (closing != integers(database, records + "'closing'") || closing.size() > 1)
    throw DamagedBytes("its closing scan and its products differ");
  contents.closing = !closing.empty();
  if (contents.closing && closing[0] != contents.closingStep()) throw DamagedBytes("steps are missing");
  const auto stored = findRunProduct(database, "end");
  if (stored.has_value() != (database.number("SELECT count(*) FROM run WHERE key='stop_reason'") == 1))
    throw DamagedBytes("its end is lost");
  if (stored) {
    const RunEnd end = openValue<RunEnd>(*stored, 0);
    if (end.steps != contents.steps || end.closing != contents.closing)
      throw DamagedBytes("steps are missing");
    contents.stop_reason = end.stop_reason;
  }
  return contents;
}

void addRealised(Database& database, StepRecord& record, int step) {
  const auto stored = findProduct(database, step, kRealisedStage, kRealisedName);
  Statement s(database, "SELECT realised_voxels IS NOT NULL OR frame IS NOT NULL FROM step WHERE step=?");
  const bool told = s.bind(step).next() && s.integer(0) == 1;
  if (told != stored.has_value()) throw DamagedBytes("its realised gain is lost");
  if (!stored) return;
  const Realised realised = openRealised(*stored, step);
  record.stage = realised.stage;
  record.realised_voxels = realised.voxels;
  record.served = realised.served;
}

/// What tells one file from another that later lies at its path.
struct FileIdentity {
  std::uint64_t device = 0, number = 0;
  std::int64_t size = 0, changed_s = 0, changed_ns = 0;
  bool there = false;
  bool sameFile(const FileIdentity& other) const {
    return there && other.there && device == other.device && number == other.number;
  }
  bool sameContent(const FileIdentity& other) const {
    return sameFile(other) && size == other.size && changed_s == other.changed_s &&
           changed_ns == other.changed_ns;
  }
};

FileIdentity identify(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return {status.st_dev, status.st_ino, status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec, true};
}

/// Grid of the octree of a run that has one.
GridGeometry octreeGrid(const RunHeader& header) {
  return OccupancyOctree::gridAround(header.volume.bounds(), header.octree->map.voxel_size_m);
}

}  // namespace

struct RunReader::State {
  fs::path path;
  RunHeader header;
  mutable std::mutex mutex;
  mutable std::unique_ptr<Database> finished;  ///< kept open once nobody writes
  FileIdentity identity;
  mutable FileIdentity finished_identity;  ///< when it was opened for good
  mutable std::mutex history_mutex;
  mutable MapHistory<TsdfBrick> volume_history;
  mutable MapHistory<OctreeBrick> octree_history;

  /// Does something with the database as it is at one moment. A run in progress is opened anew each time: a
  /// connection that stays open would keep its writer from folding the files into one.
  template <class Action>
  auto with(const std::string& task, const Action& action) const {
    const std::lock_guard lock(mutex);
    try {
      std::unique_ptr<Database> following;
      if (!finished) {
        requireSame();
        const DatabaseMode mode = modeOf(path);
        following = std::make_unique<Database>(path, mode);
        requireRun(*following);
        if (mode == DatabaseMode::Finished && following->text("PRAGMA journal_mode") != "wal")
          becomeFinished(std::move(following));
      }
      Database& database = finished ? *finished : *following;
      database.setTask(task);
      const Transaction snapshot(database, "BEGIN");
      return action(database);
    } catch (const DamagedBytes& error) {
      throw InputError(path.string(), "is damaged (" + task + ": " + error.what() +
                                          "); use a copy, or record the run again");
    } catch (const std::bad_alloc&) {
      throw InputError(path.string(),
                       task + " does not fit in memory; close other programs or use a larger machine");
    }
  }

  /// \throws InputError if the file that was opened does not lie at its path any more.
  void requireSame() const {
    requireFile(path);
    if (!identity.sameFile(identify(path)))
      throw InputError(path.string(), "was replaced by another file; open it again");
  }

  void becomeFinished(std::unique_ptr<Database> database) const {
    finished = std::move(database);
    finished_identity = identify(path);
  }

  Contents contents() const {
    return with("list of steps", [](Database& d) { return readContents(d); });
  }

  /// Brings a map from one step to another.
  template <class Brick, class Map>
  BrickSet move(MapHistory<Brick>& history, Map& map, int from_step, int step) const {
    const Contents all = contents();
    const int last = all.closing ? all.closingStep() : all.closingStep() - 1;
    if (std::min(from_step, step) < 0 || std::max(from_step, step) > last)
      throw std::invalid_argument("moving a map: steps " + std::to_string(from_step) + " to " +
                                  std::to_string(step) + " are out of range; allowed: 0 .. " +
                                  std::to_string(last));
    std::vector<MapStep> steps;
    for (const int number : all.steps) steps.push_back({number, false});
    if (all.closing) steps.push_back({all.closingStep(), true});
    const std::lock_guard lock(history_mutex);
    return history.move(map, steps, from_step, step, [&](const MapStep& at, const auto& action) {
      with("step " + std::to_string(at.number),
           [&](Database& database) { action(fetchFrom(database, at.number)); });
    });
  }

  StepRecord record(int step, bool closing, RunDetail detail) const {
    return with("step " + std::to_string(step), [&](Database& database) {
      StepRecord r = openRecord(step, closing, fetchFrom(database, step), detail);
      if (!closing) addRealised(database, r, step);
      return r;
    });
  }
};

RunReader::RunReader(const std::filesystem::path& path) : state_(std::make_unique<State>()) {
  requireFile(path);
  state_->path = path;
  state_->identity = identify(path);
  state_->header = state_->with("header", [](Database& database) {
    const auto header = findRunProduct(database, "header");
    const auto truth = findRunProduct(database, "truth");
    if (!header || !truth) throw DamagedBytes("it is missing");
    RunHeader h = openValue<RunHeader>(*header, 0);
    h.truth = openValue<TriangleMesh>(*truth, 0);
    readContourOptions(database, h.contour_config);
    if (const auto octree = findRunProduct(database, "octree"))
      h.octree = openValue<OctreeHeader>(*octree, 0);
    if (const auto arm = findRunProduct(database, "arm")) h.arm = openValue<ArmHeader>(*arm, 0);
    checkHeader(h);
    return h;
  });
  state_->contents();
}

RunReader::~RunReader() = default;

const RunHeader& RunReader::header() const {
  return state_->header;
}
std::vector<int> RunReader::steps() const {
  return state_->contents().steps;
}
bool RunReader::hasClosing() const {
  return state_->contents().closing;
}
std::optional<std::string> RunReader::stopReason() const {
  return state_->contents().stop_reason;
}
int RunReader::closingStep() const {
  return state_->contents().closingStep();
}

StepRecord RunReader::step(int step, RunDetail detail) const {
  const std::vector<int> all = steps();
  if (!std::ranges::binary_search(all, step))
    throw InputError(state_->path.string(),
                     "has no step " + std::to_string(step) +
                         (all.empty() ? "; it has none yet"
                                      : "; its steps are " + std::to_string(all.front()) + " to " +
                                            std::to_string(all.back())));
  return state_->record(step, false, detail);
}

StepRecord RunReader::closing(RunDetail detail) const {
  const Contents contents = state_->contents();
  if (!contents.closing)
    throw InputError(state_->path.string(), "has no closing scan; its last step is the last map");
  return state_->record(contents.closingStep(), true, detail);
}

std::vector<ProductInfo> RunReader::products() const {
  return state_->with("list of products", [](Database& database) {
    std::vector<ProductInfo> all;
    Statement s(database,
                "SELECT step, stage, name, raw_bytes, length(data) FROM product ORDER BY step, stage, name");
    while (s.next())
      all.push_back({static_cast<int>(s.integer(0)), s.text(1), s.text(2),
                     static_cast<std::uint64_t>(s.integer(3)), static_cast<std::uint64_t>(s.integer(4))});
    return all;
  });
}

std::vector<StepSummary> RunReader::summaries() const {
  return state_->with("list of steps", [](Database& d) { return readSummaries(d); });
}

RunFileState RunReader::fileState() const {
  const FileIdentity now = identify(state_->path);
  if (!now.there) return RunFileState::Gone;
  const std::lock_guard lock(state_->mutex);
  const bool same =
      state_->finished ? state_->finished_identity.sameContent(now) : state_->identity.sameFile(now);
  return same ? RunFileState::Same : RunFileState::Replaced;
}

BrickSet RunReader::moveVolume(TsdfVolume& volume, int from_step, int step) const {
  if (!(volume.geometry() == state_->header.volume))
    throw std::invalid_argument(
        "moveVolume: the volume differs from the run's; make it with header().volume");
  return state_->move(state_->volume_history, volume, from_step, step);
}

BrickSet RunReader::moveOctree(OccupancyOctree& octree, int from_step, int step) const {
  if (!state_->header.octree || !(octree.geometry() == octreeGrid(state_->header)))
    throw std::invalid_argument("moveOctree: the octree differs from the run's; make it with emptyOctree()");
  return state_->move(state_->octree_history, octree, from_step, step);
}

OccupancyOctree emptyOctree(const RunHeader& header) {
  if (!header.octree) throw std::invalid_argument("emptyOctree: the run has no octree");
  return {octreeGrid(header), header.octree->object_box, VoxelState::Unknown, header.octree->map.occupancy};
}

}  // namespace vantage
