# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
# Installs the core alone, builds examples/robust_tracking against it as a stranger would, and runs it.
# usage: cmake -DSOURCE=DIR -DBUILD=DIR -DCOMPILER=FILE -P example_test.cmake
set(folder ${BUILD}/test/robust_tracking)
file(REMOVE_RECURSE ${folder})
foreach(command
    "--install;${BUILD};--component;core;--prefix;${folder}/prefix"
    "-S;${SOURCE}/examples/robust_tracking;-B;${folder}/build;-DCMAKE_PREFIX_PATH=${folder}/prefix;-DCMAKE_CXX_COMPILER=${COMPILER}"
    "--build;${folder}/build")
  execute_process(COMMAND ${CMAKE_COMMAND} ${command} RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "cmake ${command} failed:\n${said}")
  endif()
endforeach()

execute_process(COMMAND ${folder}/build/robust_tracking RESULT_VARIABLE status OUTPUT_VARIABLE said)
message("${said}")
if(NOT status EQUAL 0 OR NOT said MATCHES "Kalman filter ([0-9.]+) m, robust_kf ([0-9.]+) m")
  message(FATAL_ERROR "robust_tracking ended with ${status}")
endif()
if(NOT CMAKE_MATCH_2 LESS CMAKE_MATCH_1)
  message(FATAL_ERROR "robust_kf has no smaller error than the Kalman filter")
endif()
