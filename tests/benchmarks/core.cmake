# vantage_core's bulk loops. The machine and its load stand in the context that the programs print first; the number of
# threads, where there can be more than one, is an argument of the case.
vantage_benchmark(gain_benchmark gain_benchmark.cpp workload.cpp benchmark_main.cpp LIBS vantage_raycasting TBB::tbb)
vantage_benchmark(fusion_benchmark fusion_benchmark.cpp workload.cpp benchmark_main.cpp LIBS vantage_volume TBB::tbb)
find_package(OpenMP REQUIRED)  # OctoMap's own threads
vantage_benchmark(octree_benchmark octree_benchmark.cpp benchmark_main.cpp
  LIBS vantage_volume TBB::tbb PkgConfig::OCTOMAP OpenMP::OpenMP_CXX)
vantage_benchmark(rays_benchmark rays_benchmark.cpp benchmark_main.cpp ${CMAKE_SOURCE_DIR}/tests/support/reference_room.cpp
  LIBS vantage_views TBB::tbb PkgConfig::OCTOMAP)
