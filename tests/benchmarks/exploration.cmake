vantage_benchmark(tabletop_benchmark tabletop_benchmark.cpp arm_on_tabletop.cpp search_again_benchmark.cpp tabletop_map.cpp benchmark_main.cpp
  LIBS vantage_exploration vantage_io vantage_hardware TBB::tbb)
