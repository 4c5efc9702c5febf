# vantage_io_data: data sets, images, clouds, volumes, tables, configuration.
find_package(PNG REQUIRED)
pkg_check_modules(PCL_KDTREE REQUIRED IMPORTED_TARGET pcl_common pcl_kdtree)
pkg_check_modules(yaml REQUIRED IMPORTED_TARGET yaml-0.1)
find_package(VTK REQUIRED COMPONENTS CommonCore CommonDataModel CommonExecutionModel IOXML)
pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET tomlplusplus)

vantage_library(vantage_io_data
  SOURCES
    camera_file.cpp
    cloud_file.cpp
    cloud_normals.cpp
    cloud_pcd.cpp
    config_fields.cpp
    config_fields_hierarchical.cpp
    config_fields_table.cpp
    config_file.cpp
    config_validate.cpp
    csv_table.cpp
    dataset.cpp
    dataset_layouts.cpp
    dataset_settings.cpp
    dataset_toml.cpp
    dataset_writer.cpp
    depth_png.cpp
    mesh_ply.cpp
    octree_file.cpp
    suggest.cpp
    table_file.cpp
    text_file.cpp
    volume_file.cpp
  PUBLIC vantage_core
  PRIVATE TBB::tbb PkgConfig::PCL_KDTREE PkgConfig::tomlplusplus PkgConfig::yaml PNG::PNG VTK::CommonCore VTK::CommonDataModel VTK::CommonExecutionModel
    VTK::IOXML)
