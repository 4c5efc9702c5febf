# vantage_io_data: data sets, images, clouds, volumes, tables, configuration.
add_library(vantage_io_data INTERFACE)
