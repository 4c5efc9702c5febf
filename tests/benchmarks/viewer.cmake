# What the inspector draws, through EGL; the driver stands in the label.
vantage_benchmark(inspector_benchmark inspector_benchmark.cpp tabletop_map.cpp benchmark_main.cpp
  LIBS vantage_viewer vantage_exploration vantage_io vantage_hardware)

# Of the table of candidate views.
vantage_benchmark(candidates_benchmark candidates_benchmark.cpp benchmark_main.cpp LIBS vantage_viewer)

# Of its whole window on recorded runs; memory counts only if it runs alone: --benchmark_filter=Memory.
vantage_benchmark(inspector_window_benchmark inspector_window_benchmark.cpp inspector_window.cpp ../support/process.cpp
  benchmark_main.cpp LIBS vantage_inspector)
target_compile_definitions(inspector_window_benchmark PRIVATE VANTAGE_BINARY="$<TARGET_FILE:vantage>")
add_dependencies(inspector_window_benchmark vantage)
