# What the inspector draws, through EGL; the driver stands in the label.
vantage_benchmark(inspector_benchmark inspector_benchmark.cpp tabletop_map.cpp benchmark_main.cpp
  LIBS vantage_viewer vantage_exploration vantage_io vantage_hardware)

# Of the table of candidate views.
vantage_benchmark(candidates_benchmark candidates_benchmark.cpp benchmark_main.cpp LIBS vantage_viewer)
