vantage_test(io_run_test run_file_test.cpp run_support.cpp LIBS vantage_io_run)
