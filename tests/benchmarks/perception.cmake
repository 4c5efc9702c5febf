vantage_benchmark(perception_benchmark perception_benchmark.cpp LIBS vantage_perception TBB::tbb)
