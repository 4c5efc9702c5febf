vantage_benchmark(planner_benchmark planner_benchmark.cpp benchmark_main.cpp LIBS vantage_planners TBB::tbb)
