# vantage_ros_adapter: the packages of ROS 1 that a live arm and camera need, and the headers of control_msgs, which
# Debian does not package. No such target without all of it.
find_program(ROS_GENACTION genaction.py PATHS /usr/lib/actionlib_msgs)
find_program(ROS_GENCPP gen_cpp.py PATHS /usr/lib/gencpp)
find_path(ROS_MESSAGES std_msgs/msg/Header.msg PATHS /usr/share)
if(ROS_GENACTION AND ROS_GENCPP AND ROS_MESSAGES)
  vantage_ros(vantage_ros_adapter roscpp rosconsole roscpp_serialization rostime sensor_msgs trajectory_msgs actionlib)
else()
  message(STATUS "vantage_ros_adapter: built without ROS; the generators of messages are missing (Debian: python3-gencpp "
                 "ros-actionlib-msgs)")
endif()

if(TARGET vantage_ros_adapter)
  set(python /usr/bin/python3)  # Debian's own, for which the generators are packaged
  set(sources ${CMAKE_CURRENT_LIST_DIR}/control_msgs)
  set(generated ${CMAKE_BINARY_DIR}/control_msgs)
  set(action ${sources}/action/FollowJointTrajectory.action)
  set(parts Action ActionGoal ActionResult ActionFeedback Goal Result Feedback)
  list(TRANSFORM parts REPLACE "(.+)" "${generated}/msg/FollowJointTrajectory\\1.msg" OUTPUT_VARIABLE messages)
  list(TRANSFORM parts REPLACE "(.+)" "${generated}/include/control_msgs/FollowJointTrajectory\\1.h" OUTPUT_VARIABLE headers)
  list(APPEND messages ${generated}/msg/JointTolerance.msg)
  list(APPEND headers ${generated}/include/control_msgs/JointTolerance.h)
  set(packages -Icontrol_msgs:${generated}/msg)
  foreach(package std_msgs geometry_msgs trajectory_msgs actionlib_msgs)
    list(APPEND packages -I${package}:${ROS_MESSAGES}/${package}/msg)
  endforeach()

  add_custom_command(OUTPUT ${messages}
    COMMAND ${CMAKE_COMMAND} -E copy ${sources}/msg/JointTolerance.msg ${generated}/msg/JointTolerance.msg
    COMMAND ${python} ${ROS_GENACTION} ${action} -o ${generated}/msg
    DEPENDS ${action} ${sources}/msg/JointTolerance.msg)
  foreach(message header IN ZIP_LISTS messages headers)
    add_custom_command(OUTPUT ${header}
      COMMAND ${python} ${ROS_GENCPP} ${message} ${packages} -p control_msgs -o ${generated}/include/control_msgs
              -e ${ROS_MESSAGES}/gencpp
      DEPENDS ${messages})
  endforeach()
  add_custom_target(vantage_control_msgs DEPENDS ${headers})

  target_include_directories(vantage_ros_adapter SYSTEM INTERFACE ${generated}/include)
  add_dependencies(vantage_ros_adapter vantage_control_msgs)
endif()
