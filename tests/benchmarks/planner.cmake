vantage_benchmark(planner_benchmark planner_benchmark.cpp benchmark_main.cpp LIBS vantage_planners TBB::tbb)
# Kinematics and collisions of the embedded arms.
vantage_benchmark(arm_benchmark arm_benchmark.cpp benchmark_main.cpp LIBS vantage_motion vantage_io_scene)
