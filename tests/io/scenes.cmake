vantage_test(io_scene_test
  robot_file_test.cpp
  scene_base_test.cpp
  scene_embedded_test.cpp
  scene_experiments_test.cpp
  scene_file_test.cpp
  scene_mesh_test.cpp
  scene_solid_test.cpp
  scene_truth_test.cpp
  LIBS vantage_io_scene vantage_io_data TBB::tbb)
