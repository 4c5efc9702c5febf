# vantage_io_run: the run file and its JSON summary.
find_package(SQLite3 REQUIRED)
find_package(nlohmann_json REQUIRED)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)

vantage_library(vantage_io_run
  SOURCES json_summary.cpp run_bytes.cpp run_codec.cpp run_database.cpp run_maps.cpp run_reader.cpp run_robot.cpp run_schema.cpp run_summaries.cpp run_writer.cpp
  PUBLIC vantage_exploration vantage_io_data
  PRIVATE SQLite::SQLite3 PkgConfig::ZSTD TBB::tbb nlohmann_json::nlohmann_json)
