vantage_test(config_file_test config_file_test.cpp suggest_test.cpp LIBS vantage_io_data)
vantage_test(dataset_test dataset_test.cpp depth_png_test.cpp LIBS vantage_io_data)
vantage_test(volume_file_test volume_file_test.cpp LIBS vantage_io_data)
