# ROS 1, found in one place: vantage_ros(TARGET MODULES...) makes an interface library TARGET of these
# pkg-config modules; their headers count as system headers. There is no such target, and the status output
# says why, without VANTAGE_ROS or where a module is missing: ask if(TARGET ...). Sources with headers of ROS
# have to be C++17.
function(vantage_ros target)
  if(NOT VANTAGE_ROS)
    message(STATUS "${target}: built without ROS (VANTAGE_ROS=OFF)")
    return()
  endif()
  pkg_check_modules(${target}_modules QUIET IMPORTED_TARGET GLOBAL ${ARGN})
  if(NOT ${target}_modules_FOUND)
    message(STATUS "${target}: built without ROS; not all of these were found: ${ARGN}")
    return()
  endif()
  add_library(${target} INTERFACE)
  target_link_libraries(${target} INTERFACE PkgConfig::${target}_modules)
endfunction()
