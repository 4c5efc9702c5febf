# vantage_io_scene: scene files, solids, meshes, ground truth, embedded assets.
add_library(vantage_io_scene INTERFACE)
