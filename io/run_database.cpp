#include "io/run_database.h"

#include <sqlite3.h>

#include <cerrno>
#include <stdexcept>

#include "io/error.h"

namespace vantage {
namespace {

constexpr int kBusyTimeout_ms = 5000;

/// Steps of SQLite's machine after which a query is given up: only a forged file takes so many.
constexpr int kProgressEvery = 1'000'000;
constexpr int kProgressCalls = 2'000;

int countCalls(void* left) {
  return --*static_cast<int*>(left) <= 0;
}

/// Path as a URI, in which SQLite's options can be given.
std::string uri(const std::filesystem::path& path, DatabaseMode mode) {
  std::string text = "file:";
  for (const char c : std::filesystem::absolute(path).string()) {
    if (c == '%' || c == '?' || c == '#') {
      constexpr char kHex[] = "0123456789abcdef";
      text += {'%', kHex[(c >> 4) & 15], kHex[c & 15]};
    } else {
      text += c;
    }
  }
  if (mode == DatabaseMode::Write) return text + "?mode=rwc";
  return text + (mode == DatabaseMode::Finished ? "?mode=ro&immutable=1" : "?mode=ro");
}

bool diskFull(int code, int system_errno) {
  return (code & 0xff) == SQLITE_FULL || system_errno == ENOSPC || system_errno == EFBIG ||
         system_errno == EDQUOT;
}

}  // namespace

Database::Database(const std::filesystem::path& path, DatabaseMode mode) : name_(path.string()), mode_(mode) {
  const int access =
      mode == DatabaseMode::Write ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY;
  const int code = sqlite3_open_v2(uri(path, mode).c_str(), &db_,
                                   access | SQLITE_OPEN_URI | SQLITE_OPEN_FULLMUTEX, nullptr);
  try {
    if (code != SQLITE_OK) fail(code);
    sqlite3_extended_result_codes(db_, 1);
    sqlite3_busy_timeout(db_, kBusyTimeout_ms);
    sqlite3_db_config(db_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    run("PRAGMA cell_size_check=ON");
  } catch (...) {
    sqlite3_close(db_);
    throw;
  }
}

Database::~Database() {
  sqlite3_close(db_);
}

void Database::fail(int code) {
  const std::string reason = db_ ? sqlite3_errmsg(db_) : sqlite3_errstr(code);
  const int system_errno = db_ ? sqlite3_system_errno(db_) : 0;
  if (mode_ == DatabaseMode::Write) {
    const std::string what = name_ + ": " + (task_.empty() ? "" : task_ + ": ");
    const int primary = code & 0xff;
    if (diskFull(code, system_errno))
      throw std::runtime_error(what +
                               "disk full; what was recorded before is kept; free some space and run again");
    if (primary == SQLITE_IOERR)
      throw std::runtime_error(
          what + "cannot write (" + reason +
          "), disk full or device failing; what was recorded before is kept; check the disk");
    throw std::runtime_error(what + "cannot write (" + reason + ")");
  }
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw InputError(name_, "is locked by another program; try again when that has finished");
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
    case SQLITE_PERM:
      throw InputError(
          name_, "cannot be opened (" + reason +
                     "); check permissions, or copy it with its -wal file to a folder that is writable");
    case SQLITE_NOTADB:
      throw InputError(name_, "is not a run file; give a .vantage file that `vantage explore -o` wrote");
    case SQLITE_NOMEM:
      throw std::bad_alloc();
    default:
      throw InputError(name_, "is damaged (" + (task_.empty() ? "" : task_ + ": ") + reason +
                                  "); use a copy, or record the run again");
  }
}

void Database::run(const std::string& sql) {
  const int code = sqlite3_exec(db_, sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code);
}

std::int64_t Database::number(const std::string& sql) {
  Statement statement(*this, sql);
  return statement.next() ? statement.integer(0) : 0;
}

std::string Database::text(const std::string& sql) {
  Statement statement(*this, sql);
  return statement.next() ? statement.text(0) : std::string();
}

Statement::Statement(Database& database, const std::string& sql) : database_(database) {
  const int code = sqlite3_prepare_v2(database.handle(), sql.c_str(), -1, &statement_, nullptr);
  if (code != SQLITE_OK) database.fail(code);
}

Statement::~Statement() {
  sqlite3_finalize(statement_);
}

Statement& Statement::bind(std::int64_t value) {
  sqlite3_bind_int64(statement_, ++parameter_, value);
  return *this;
}
Statement& Statement::bind(double value) {
  sqlite3_bind_double(statement_, ++parameter_, value);
  return *this;
}
Statement& Statement::bind(const std::string& value) {
  sqlite3_bind_text(statement_, ++parameter_, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
  return *this;
}
Statement& Statement::bind(std::span<const std::uint8_t> blob) {
  sqlite3_bind_blob64(statement_, ++parameter_, blob.data(), blob.size(), SQLITE_STATIC);
  return *this;
}
Statement& Statement::bindNull() {
  sqlite3_bind_null(statement_, ++parameter_);
  return *this;
}

bool Statement::next() {
  int left = kProgressCalls;
  sqlite3_progress_handler(database_.handle(), kProgressEvery, &countCalls, &left);
  const int code = sqlite3_step(statement_);
  sqlite3_progress_handler(database_.handle(), 0, nullptr, nullptr);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) database_.fail(code);
  return false;
}

void Statement::reset() {
  sqlite3_reset(statement_);
  sqlite3_clear_bindings(statement_);
  parameter_ = 0;
}

bool Statement::isNull(int column) const {
  return sqlite3_column_type(statement_, column) == SQLITE_NULL;
}
std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_, column);
}
double Statement::real(int column) const {
  return sqlite3_column_double(statement_, column);
}
std::string Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
  return text ? std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))) : "";
}
std::vector<std::uint8_t> Statement::blob(int column) const {
  const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_, column));
  return data ? std::vector<std::uint8_t>(data, data + sqlite3_column_bytes(statement_, column))
              : std::vector<std::uint8_t>();
}
std::int64_t Statement::blobSize(int column) const {
  return sqlite3_column_bytes(statement_, column);
}

Transaction::Transaction(Database& database, const char* begin) : database_(database) {
  database_.run(begin);
}
Transaction::~Transaction() {
  if (open_ && !sqlite3_get_autocommit(database_.handle()))
    sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}
void Transaction::commit() {
  database_.run("COMMIT");
  open_ = false;
}

}  // namespace vantage
