# vantage_io_data: data sets, images, clouds, volumes, tables, configuration.
find_package(PNG REQUIRED)
pkg_check_modules(PCL_KDTREE REQUIRED IMPORTED_TARGET pcl_common pcl_kdtree)
pkg_check_modules(yaml REQUIRED IMPORTED_TARGET yaml-0.1)
find_package(VTK REQUIRED COMPONENTS CommonCore CommonDataModel CommonExecutionModel IOXML)
pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET tomlplusplus)

# Recordings of ROS 1.
find_package(BZip2 QUIET)
if(BZIP2_FOUND)
  vantage_ros(vantage_ros_bag tf2 liblz4)
endif()
if(TARGET vantage_ros_bag)
  set(VANTAGE_BAG_SOURCES bag_dataset.cpp bag_depth.cpp bag_file.cpp bag_messages.cpp bag_poses.cpp bag_topics.cpp)
  set(VANTAGE_BAG_LIBRARIES vantage_ros_bag BZip2::BZip2)
  set_source_files_properties(bag_poses.cpp PROPERTIES COMPILE_OPTIONS -std=c++17)  # as the headers of ROS 1
else()
  set(VANTAGE_BAG_SOURCES bag_dataset_absent.cpp)
  set(VANTAGE_BAG_LIBRARIES)
endif()

vantage_library(vantage_io_data
  SOURCES
    ${VANTAGE_BAG_SOURCES}
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
  PRIVATE ${VANTAGE_BAG_LIBRARIES} TBB::tbb PkgConfig::PCL_KDTREE PkgConfig::tomlplusplus PkgConfig::yaml PNG::PNG VTK::CommonCore VTK::CommonDataModel VTK::CommonExecutionModel
    VTK::IOXML)
