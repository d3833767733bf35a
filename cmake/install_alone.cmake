# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
# Installation without ROS: find_package(sas_motion) gives sas_motion::core, and sas_motion::graph where it was built.
# In a catkin build it is the core's alone, and only on request, beside catkin's own:
#   cmake --install BUILD --component core --prefix PREFIX
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(sas_motion_libraries sas_motion_core)
set(sas_motion_component COMPONENT core)
set(sas_motion_exports_graph OFF)
if(SAS_MOTION_ROS)
  list(APPEND sas_motion_component EXCLUDE_FROM_ALL)
elseif(SAS_MOTION_GTSAM)
  list(APPEND sas_motion_libraries sas_motion_graph)
  set(sas_motion_exports_graph ON)
  set_target_properties(sas_motion_graph PROPERTIES EXPORT_NAME graph)
endif()
set_target_properties(sas_motion_core PROPERTIES EXPORT_NAME core)

set(sas_motion_package ${CMAKE_INSTALL_LIBDIR}/cmake/sas_motion)
configure_package_config_file(cmake/sas_motionConfig.cmake.in ${PROJECT_BINARY_DIR}/cmake/sas_motionConfig.cmake INSTALL_DESTINATION ${sas_motion_package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmake/sas_motionConfigVersion.cmake COMPATIBILITY SameMinorVersion)

install(TARGETS ${sas_motion_libraries} EXPORT sas_motion LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ${sas_motion_component})
install(EXPORT sas_motion FILE sas_motionTargets.cmake NAMESPACE sas_motion:: DESTINATION ${sas_motion_package} ${sas_motion_component})
install(DIRECTORY include/sas_motion DESTINATION include ${sas_motion_component})
install(FILES ${PROJECT_BINARY_DIR}/cmake/sas_motionConfig.cmake ${PROJECT_BINARY_DIR}/cmake/sas_motionConfigVersion.cmake cmake/geographiclib.cmake
  DESTINATION ${sas_motion_package} ${sas_motion_component})
