# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
# The catkin package: what of ROS it needs, its messages, and what it says to other packages.
find_package(catkin REQUIRED COMPONENTS
  diagnostic_updater dynamic_reconfigure geometry_msgs message_generation nav_msgs nodelet pluginlib rosbag roscpp roslz4 sensor_msgs std_msgs std_srvs tf2 tf2_msgs tf2_ros)

add_message_files(FILES FilterUpdate.msg MeasurementLabel.msg UsblCalibration.msg UsblMeasurement.msg)
add_service_files(FILES EnableSensor.srv GetStateAt.srv SetDatum.srv SetState.srv)
generate_messages(DEPENDENCIES geometry_msgs nav_msgs std_msgs)
generate_dynamic_reconfigure_options(cfg/Estimators.cfg)
catkin_package(
  INCLUDE_DIRS include
  LIBRARIES sas_motion_core sas_motion_graph sas_motion_ros
  CATKIN_DEPENDS dynamic_reconfigure geometry_msgs message_runtime nav_msgs nodelet roscpp sensor_msgs std_msgs std_srvs tf2 tf2_ros
  DEPENDS EIGEN3)
