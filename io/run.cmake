# vantage_io_run: the run file and its JSON summary.
add_library(vantage_io_run INTERFACE)
