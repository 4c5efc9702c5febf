# vantage_io_data: data sets, images, clouds, volumes, tables, configuration.
pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET tomlplusplus)

vantage_library(vantage_io_data
  SOURCES
    config_fields.cpp
    config_fields_table.cpp
    config_file.cpp
    config_validate.cpp
    suggest.cpp
  PUBLIC vantage_core
  PRIVATE PkgConfig::tomlplusplus)
