vantage_benchmark(tabletop_benchmark tabletop_benchmark.cpp benchmark_main.cpp
  LIBS vantage_exploration vantage_io vantage_hardware TBB::tbb)
