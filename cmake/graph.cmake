# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
# The factor graphs, on GTSAM.
find_package(GTSAM 4 REQUIRED)
find_package(GTSAM_UNSTABLE REQUIRED)

add_library(sas_motion_graph SHARED
  src/systems/ins_gps_dvl/graph/chain.cpp
  src/systems/ins_gps_dvl/graph/factors.cpp
  src/systems/ins_gps_dvl/graph/node.cpp
  src/systems/ins_gps_dvl/graph/smoother.cpp
  src/systems/ins_gps_dvl/graph/window.cpp
  src/systems/sins_dvl/graph/estimators.cpp
  src/systems/towfish/graph/batch.cpp
  src/systems/towfish/graph/estimators.cpp
  src/systems/towfish/graph/factors.cpp
  src/systems/towfish/graph/fixed_lag.cpp
  src/systems/usbl/graph/batch.cpp
  src/systems/usbl/graph/factors.cpp
)
add_library(sas_motion::graph ALIAS sas_motion_graph)
target_include_directories(sas_motion_graph PRIVATE src)
target_link_libraries(sas_motion_graph PUBLIC sas_motion_core gtsam gtsam_unstable PRIVATE sas_motion_flags)
