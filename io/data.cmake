# vantage_io_data: data sets, images, clouds, volumes, tables, configuration.
find_package(PNG REQUIRED)
find_package(VTK REQUIRED COMPONENTS CommonCore CommonDataModel CommonExecutionModel IOXML)
pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET tomlplusplus)

vantage_library(vantage_io_data
  SOURCES
    config_fields.cpp
    config_fields_table.cpp
    config_file.cpp
    config_validate.cpp
    dataset.cpp
    dataset_layouts.cpp
    dataset_settings.cpp
    dataset_toml.cpp
    depth_png.cpp
    suggest.cpp
    text_file.cpp
    volume_file.cpp
  PUBLIC vantage_core
  PRIVATE PkgConfig::tomlplusplus PNG::PNG VTK::CommonCore VTK::CommonDataModel VTK::CommonExecutionModel
    VTK::IOXML)
