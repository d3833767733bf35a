# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The front door. Each target sets up what it needs: packages, GTSAM, the build.
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
export PATH := /usr/bin:$(PATH)

BUILD ?= build
OUT ?= compare
# outside this folder: ROS searches it for executables and would find each tool twice
PREFIX ?= /opt/sas_motion
CMAKE_FLAGS ?=
GENERATOR := -G Ninja
WITH_ROS := if [ -r /opt/ros/noetic/setup.bash ]; then set +u; source /opt/ros/noetic/setup.bash; set -u; fi
# what scripts/compare.sh and compare.launch run: two tools and the nodelets
COMPARED := simulate sas_motion_metrics sas_motion_ros
COMPILE = NINJA_STATUS="build: %f of %t: " cmake --build $(BUILD) -j $$(nproc)
ENVIRONMENT := set +u; source devel/setup.bash; set -u

.PHONY: help setup configure build compare test bench check install clean

help:  ## what there is
	@grep -E '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## */  make \1\t/' | expand -t 18

setup:  ## install Debian packages and GTSAM, where missing
	@scripts/setup.sh

configure: setup
	@echo "build: configuring"
	@$(WITH_ROS); cmake -S . -B $(BUILD) $(GENERATOR) -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCATKIN_DEVEL_PREFIX=$(CURDIR)/devel -DCMAKE_INSTALL_PREFIX=$(PREFIX) $(CMAKE_FLAGS) > $(BUILD)-configure.log 2>&1 \
	  || { mkdir -p $(BUILD); tail -n 20 $(BUILD)-configure.log; echo "build: CMake could not configure; its log is $(BUILD)-configure.log" >&2; exit 1; }

build: configure  ## build everything, in build/ and devel/
	@echo "build: compiling everything (about 6 minutes on two cores the first time)"
	@$(COMPILE)

compare: configure  ## simulate, launch nodelet and smoother, evaluate both against truth, write compare/report.html
	@echo "build: compiling what the comparison needs, half of everything (about 4 minutes on two cores the first time)"
	@$(COMPILE) --target $(COMPARED)
	@$(ENVIRONMENT); scripts/compare.sh $(OUT)

test: build  ## run every test
	@$(ENVIRONMENT); scripts/run_tests.sh $(BUILD)

bench: build  ## measure accuracy, speed and memory; SMOKE=1 for the smallest size
	@scripts/setup.sh libopencv-video-dev libopencv-core-dev
	@$(ENVIRONMENT); scripts/bench.sh $(BUILD)

check: build  ## formatting, lint and sanitizers
	@scripts/setup.sh clang-format clang-tidy
	@BUILD=$(BUILD) scripts/check.sh

install: build  ## install into PREFIX (default: /opt/sas_motion), which runs without the source tree
	@cmake --install $(BUILD) > /dev/null && echo "install: source $(PREFIX)/setup.bash"

clean:  ## remove what was built
	@rm -rf $(BUILD) $(BUILD)-configure.log devel
