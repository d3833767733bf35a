# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
# Nodelets, bags and tools, and the installation of the catkin package.
find_package(BZip2 REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)

add_library(sas_motion_ros SHARED
  src/bag/bag_output.cpp
  src/bag/bag_reader.cpp
  src/bag/bag_writer.cpp
  src/bag/chunk_file.cpp
  src/bag/decompress.cpp
  src/bag/recording.cpp
  src/bag/reprocess.cpp
  src/bag/topics.cpp
  src/bag/tum.cpp
  src/ros/batch_solver.cpp
  src/ros/diagnostics.cpp
  src/ros/inbox.cpp
  src/ros/messages.cpp
  src/ros/publisher.cpp
  src/ros/reconfigure.cpp
  src/ros/server.cpp
  src/ros/services.cpp
  src/ros/settings.cpp
  src/ros/solution_messages.cpp
  src/ros/system.cpp
  src/ros/system_run.cpp
  src/systems/ins_gps_dvl/ros/conversions.cpp
  src/systems/ins_gps_dvl/ros/recorder.cpp
  src/systems/ins_gps_dvl/ros/run.cpp
  src/systems/ins_gps_dvl/ros/system.cpp
  src/systems/nodelets.cpp
  src/systems/registry.cpp
  src/systems/sins_dvl/ros/system.cpp
  src/systems/towfish/ros/recorder.cpp
  src/systems/towfish/ros/system.cpp
  src/systems/usbl/ros/calibration_document.cpp
  src/systems/usbl/ros/calibration_result.cpp
  src/systems/usbl/ros/calibration_server.cpp
  src/systems/usbl/ros/calibration_trace.cpp
  src/systems/usbl/ros/conversions.cpp
  src/systems/usbl/ros/ingest.cpp
  src/systems/usbl/ros/recorder.cpp
  src/systems/usbl/ros/recording.cpp
)
add_library(sas_motion::ros ALIAS sas_motion_ros)
add_dependencies(sas_motion_ros ${PROJECT_NAME}_generate_messages_cpp ${PROJECT_NAME}_gencfg)
target_include_directories(sas_motion_ros PRIVATE src)
target_include_directories(sas_motion_ros SYSTEM PUBLIC ${catkin_INCLUDE_DIRS} ${CATKIN_DEVEL_PREFIX}/include)
target_link_libraries(sas_motion_ros PUBLIC sas_motion_graph ${catkin_LIBRARIES} PRIVATE BZip2::BZip2 nlohmann_json::nlohmann_json sas_motion_flags)

add_library(sas_motion_tools STATIC src/tools/progress.cpp)
target_include_directories(sas_motion_tools PUBLIC src)
target_link_libraries(sas_motion_tools PUBLIC fmt::fmt CLI11::CLI11 nlohmann_json::nlohmann_json PRIVATE sas_motion_flags)

# name of the tool, the library it stands on, and further sources beside its own
set(sas_motion_executables)
function(sas_motion_tool name library)
  list(TRANSFORM ARGN PREPEND src/tools/ OUTPUT_VARIABLE others)
  add_executable(${name} src/tools/${name}.cpp ${others})
  target_link_libraries(${name} PRIVATE ${library} sas_motion_tools sas_motion_flags)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION})
  set(sas_motion_executables ${sas_motion_executables} ${name} PARENT_SCOPE)
endfunction()
# Results of one state of the code are not taken for another's.
execute_process(COMMAND git describe --always --dirty WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE sas_motion_commit ERROR_QUIET
  OUTPUT_STRIP_TRAILING_WHITESPACE)
if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/.git/logs/HEAD)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/.git/logs/HEAD)
endif()
string(JOIN "-" sas_motion_version ${PROJECT_VERSION} ${sas_motion_commit})
sas_motion_tool(run_campaign sas_motion_ros focus_document.cpp)
target_compile_definitions(run_campaign PRIVATE SAS_MOTION_VERSION="${sas_motion_version}")
sas_motion_tool(simulate sas_motion_ros)
sas_motion_tool(calibrate_usbl sas_motion_ros)
if(SAS_MOTION_IMAGING)
  sas_motion_tool(focus sas_motion_ros focus_document.cpp focus_input.cpp focus_window.cpp)
endif()
sas_motion_tool(plan_track sas_motion_ros)
sas_motion_tool(reprocess sas_motion_ros)
sas_motion_tool(sas_motion_metrics sas_motion_ros)

# Python tools stand beside the C++ tools; their packages are folders there.
set(sas_motion_scripts
  scripts/benchmark scripts/calibration_report.py scripts/evaluate.py scripts/nmea_to_bag scripts/play_session.py scripts/plot_focus.py scripts/plot_image.py scripts/view_markers.py)
catkin_install_python(PROGRAMS ${sas_motion_scripts} DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(PROGRAMS scripts/compare.sh DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(DIRECTORY scripts/sas_motion_calibration scripts/sas_motion_campaign scripts/sas_motion_nmea scripts/sas_motion_report DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION} PATTERN __pycache__ EXCLUDE)
install(TARGETS ${sas_motion_executables} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(TARGETS sas_motion_core sas_motion_graph sas_motion_ros LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})
install(DIRECTORY launch config bags DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
install(FILES nodelet_plugins.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
