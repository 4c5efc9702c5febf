# vantage_io_scene: scene files, solids, meshes, rays through them, ground truth, embedded assets.
include(embed)
find_package(embree 3 REQUIRED)
pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET tomlplusplus)

vantage_library(vantage_io_scene
  SOURCES
    embedded_assets.cpp
    mesh_file.cpp
    robot_file.cpp
    scene_compose.cpp
    scene_file.cpp
    scene_rays.cpp
    scene_solids.cpp
    scene_table.cpp
    scene_truth.cpp
    solid.cpp
    solid_lathe.cpp
    solid_mesh.cpp
    solid_tube.cpp
  PUBLIC vantage_core
  PRIVATE vantage_io_data embree TBB::tbb PkgConfig::tomlplusplus)

# Files below assets/ that the program carries with it.
vantage_embed_assets(vantage_io_scene
  robots/smart_six.urdf
  robots/ur5.urdf
  scenes/a1_compact.toml
  scenes/a1_elongated.toml
  scenes/a3_room.toml
  scenes/apart.toml
  scenes/apart_open.toml
  scenes/b3_planes.toml
  scenes/b4_bar.toml
  scenes/box.toml
  scenes/clutter.toml
  scenes/clutter_open.toml
  scenes/room.toml
  scenes/row.toml
  scenes/row_open.toml
  scenes/tabletop.toml
  scenes/tabletop_open.toml
  scenes/tuning_a.toml
  scenes/tuning_b.toml
  scenes/unseen_kitchen.toml
  scenes/unseen_workshop.toml)
