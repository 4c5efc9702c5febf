#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace vantage {

/// Identity of run files: "VNTG" in SQLite's application id, the version of their layout in its user version.
inline constexpr std::uint32_t kRunApplicationId = 0x564e5447;
inline constexpr int kRunVersion = 4;

/// How a database is opened.
enum class DatabaseMode {
  Write,     ///< read and write; failures are std::runtime_error
  Follow,    ///< read while another process may write; failures are InputError
  Finished,  ///< read a file that nobody writes any more; makes no side files; failures are InputError
};

/// One SQLite connection. Errors name the file and say what to do.
class Database {
 public:
  Database(const std::filesystem::path& path, DatabaseMode mode);
  ~Database();
  Database(const Database&) = delete;

  /// Runs statements without parameters or results.
  void run(const std::string& sql);
  /// First column of the first row as an integer, 0 if there is none.
  std::int64_t number(const std::string& sql);
  /// First column of the first row as text, empty if there is none.
  std::string text(const std::string& sql);

  /// Throws the error that fits the connection's mode for SQLite's result `code`.
  [[noreturn]] void fail(int code);
  /// What is being done, for error messages: "step 3".
  void setTask(std::string task) { task_ = std::move(task); }
  sqlite3* handle() { return db_; }
  const std::string& name() const { return name_; }

 private:
  sqlite3* db_ = nullptr;
  std::string name_;
  std::string task_;
  DatabaseMode mode_;
};

/// A prepared statement: bind the parameters in order, then step.
class Statement {
 public:
  Statement(Database& database, const std::string& sql);
  ~Statement();
  Statement(const Statement&) = delete;

  Statement& bind(std::int64_t value);
  Statement& bind(std::uint64_t value) { return bind(static_cast<std::int64_t>(value)); }
  Statement& bind(int value) { return bind(static_cast<std::int64_t>(value)); }
  Statement& bind(std::uint32_t value) { return bind(static_cast<std::int64_t>(value)); }
  Statement& bind(bool value) { return bind(static_cast<std::int64_t>(value)); }
  Statement& bind(double value);
  Statement& bind(const std::string& value);
  Statement& bind(const char* value) { return bind(std::string(value)); }
  Statement& bind(std::span<const std::uint8_t> blob);  ///< must live until the statement has run
  Statement& bindNull();
  template <class T>
  Statement& bind(const std::optional<T>& value) {
    return value ? bind(*value) : bindNull();
  }

  bool next();  ///< true while there is a row
  void finish() {
    while (next()) {
    }
    reset();
  }  ///< runs a statement without results; ready for the next parameters
  void reset();

  bool isNull(int column) const;
  std::int64_t integer(int column) const;
  double real(int column) const;
  std::string text(int column) const;
  std::vector<std::uint8_t> blob(int column) const;
  std::int64_t blobSize(int column) const;

 private:
  Database& database_;
  sqlite3_stmt* statement_ = nullptr;
  int parameter_ = 0;
};

/// A transaction: undone unless committed.
class Transaction {
 public:
  Transaction(Database& database, const char* begin);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
  bool open_ = true;
};

}  // namespace vantage
