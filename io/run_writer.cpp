#include <chrono>
#include <fstream>
#include <set>
#include <stdexcept>
#include <thread>

#include "io/error.h"
#include "io/run_codec.h"
#include "io/run_database.h"
#include "io/run_fields.h"
#include "io/run_file.h"
#include "io/run_schema.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr int kPageBytes = 16384;
constexpr auto kCloseWait = std::chrono::seconds(3);  // for readers in the middle of a step

fs::path beside(const fs::path& path, const char* suffix) {
  return fs::path(path.string() + suffix);
}

void removeSideFiles(const fs::path& path) {
  for (const char* suffix : {"-wal", "-shm", "-journal"}) fs::remove(beside(path, suffix));
}

/// Whether a file that lies at the path may be replaced: a run, an empty file, or anything that is called
/// one.
bool replaceable(const fs::path& path) {
  if (path.extension() == ".vantage" || fs::file_size(path) == 0) return true;
  std::array<unsigned char, 72> head{};
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(head.data()), head.size());
  const std::uint32_t id = head[68] << 24 | head[69] << 16 | head[70] << 8 | head[71];
  return file.gcount() == static_cast<std::streamsize>(head.size()) && id == kRunApplicationId;
}

void requireWritable(const fs::path& path) {
  const fs::path folder = fs::absolute(path).parent_path();
  if (!fs::is_directory(folder))
    throw InputError(path.string(), "its folder does not exist; create " + folder.string() + " first");
  if (!fs::exists(path)) return;
  if (!fs::is_regular_file(path))
    throw InputError(path.string(), "is not a regular file; choose another name");
  if (!replaceable(path))
    throw InputError(path.string(), "exists and is not a run file; choose another name or remove it");
}

/// Makes a run file without steps beside its place and moves it there, so that whoever follows never sees
/// half a header.
void createFile(const fs::path& path, const RunHeader& header) {
  const fs::path fresh = beside(path, "-new");
  fs::remove(fresh);
  removeSideFiles(fresh);
  {
    Database database(fresh, DatabaseMode::Write);
    database.setTask("header");
    database.run("PRAGMA page_size=" + std::to_string(kPageBytes));
    database.run("PRAGMA journal_mode=WAL");
    Transaction transaction(database, "BEGIN IMMEDIATE");
    createSchema(database);
    insertHeader(database, header);
    putRunProduct(database, storeValue("run", "header", 0, header));
    putRunProduct(database, storeValue("run", "truth", 0, header.truth));
    const ContourOptions options{header.contour_config.contours.normal, header.contour_config.gain.count};
    putRunProduct(database, storeValue("run", "contour options", 0, options));
    if (header.octree) putRunProduct(database, storeValue("run", "octree", 0, *header.octree));
    if (header.arm) putRunProduct(database, storeValue("run", "arm", 0, *header.arm));
    transaction.commit();
  }
  removeSideFiles(path);
  fs::rename(fresh, path);
}

}  // namespace

struct RunWriter::State {
  Database database;
  std::set<int> steps;
  bool closing = false;
  bool open = true;

  explicit State(const fs::path& path) : database(path, DatabaseMode::Write) {
    database.run("PRAGMA journal_mode=WAL");
    database.run("PRAGMA synchronous=FULL");
  }

  int last() const { return steps.empty() ? 0 : *steps.rbegin(); }
  void setRealised(const Realised& realised, int step);
  void fold();
};

/// Everything into the one file. A reader in the middle of a step holds the side files for a moment; if they
/// can't go, the run is whole with them.
void RunWriter::State::fold() {
  if (!open) return;
  open = false;
  database.setTask("closing");
  const auto until = std::chrono::steady_clock::now() + kCloseWait;
  database.run("PRAGMA wal_checkpoint(TRUNCATE)");
  database.run("PRAGMA busy_timeout=0");
  for (;;) {
    try {
      if (database.text("PRAGMA journal_mode=DELETE") == "delete") return;
    } catch (const std::runtime_error&) {
      if (std::chrono::steady_clock::now() > until) throw;
    }
    if (std::chrono::steady_clock::now() > until) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void RunWriter::State::setRealised(const Realised& realised, int step) {
  if (!steps.contains(step))
    throw std::invalid_argument(database.name() + ": no step " + std::to_string(step) + " to fill in");
  database.setTask("step " + std::to_string(step));
  Transaction transaction(database, "BEGIN IMMEDIATE");
  putProduct(database, storeRealised(realised, step), step);
  updateRealised(database, realised, step);
  transaction.commit();
}

RunWriter::RunWriter(const std::filesystem::path& path, const RunHeader& header) {
  try {
    requireWritable(path);
    createFile(path, header);
    state_ = std::make_unique<State>(path);
  } catch (const InputError&) {
    throw;
  } catch (const fs::filesystem_error& error) {
    throw InputError(path.string(),
                     "cannot be created (" + error.code().message() + "); choose another place");
  } catch (const std::runtime_error& error) {
    throw InputError(path.string(),
                     std::string("cannot be created (") + error.what() + "); choose another place");
  }
}

RunWriter::~RunWriter() {
  if (!state_) return;
  try {
    state_->fold();
  } catch (...) {  // nowhere to report it; the steps stay readable with the side files
  }
}

void RunWriter::write(const StepRecord& record) {
  State& s = *state_;
  const int step = record.closing ? s.last() + 1 : record.step;
  if (s.closing || step <= s.last())
    throw std::invalid_argument(s.database.name() + ": step " + std::to_string(step) +
                                " is written already; steps are written once, in ascending order");
  s.database.setTask("step " + std::to_string(step));
  const std::vector<StoredProduct> products = storeRecord(record, step);
  Transaction transaction(s.database, "BEGIN IMMEDIATE");
  for (const StoredProduct& product : products) putProduct(s.database, product, step);
  record.closing ? insertClosing(s.database, record, step) : insertStep(s.database, record, step);
  if (!record.closing && (record.realised_voxels || record.served))
    putProduct(s.database, storeRealised({record.stage, record.realised_voxels, record.served}, step), step);
  transaction.commit();
  if (record.closing) {
    s.closing = true;
  } else {
    s.steps.insert(step);
  }
}

void RunWriter::setRealised(const StepRecord& record) {
  state_->setRealised({record.stage, record.realised_voxels, record.served}, record.step);
}

void RunWriter::finish(const std::string& stop_reason) {
  State& s = *state_;
  s.database.setTask("stop reason");
  RunEnd end;
  end.stop_reason = stop_reason;
  end.steps.assign(s.steps.begin(), s.steps.end());
  end.closing = s.closing;
  {
    Transaction transaction(s.database, "BEGIN IMMEDIATE");
    putRunValue(s.database, "stop_reason", stop_reason);
    putRunProduct(s.database, storeValue("run", "end", 0, end));
    transaction.commit();
  }
  s.fold();
}

}  // namespace vantage
