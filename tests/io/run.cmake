pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
vantage_test(io_run_test run_file_test.cpp run_crash_test.cpp run_fields_test.cpp json_summary_test.cpp run_support.cpp
  LIBS vantage_io_run nlohmann_json::nlohmann_json PkgConfig::ZSTD)
