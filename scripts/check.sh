#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Formatting, lint and sanitizers. usage: scripts/check.sh [format|tidy|sanitize]; all of them without a word.
set -euo pipefail
cd "$(dirname "$0")/.."
what=${1:-all}
mapfile -t sources < <(git ls-files 'include/*.hpp' 'src/*.cpp' 'src/*.hpp' 'test/*.cpp' 'test/*.hpp' 'benchmark/*.cpp')

if [ "$what" = format ] || [ "$what" = all ]; then
  echo "check: clang-format"
  clang-format --dry-run --Werror "${sources[@]}" || { echo "check: run 'clang-format -i' on these files" >&2; exit 1; }
fi
if [ "$what" = tidy ] || [ "$what" = all ]; then
  echo "check: clang-tidy"
  cmake -S . -B build -DCMAKE_EXPORT_COMPILE_COMMANDS=ON >/dev/null
  git ls-files 'src/*.cpp' | grep -v factor_graph | xargs -P "$(nproc)" -n 1 clang-tidy -p build --quiet --warnings-as-errors='*'
fi
if [ "$what" = sanitize ] || [ "$what" = all ]; then
  echo "check: the core's tests under address and undefined-behaviour sanitizers"
  flags='-fsanitize=address,undefined -fno-sanitize-recover=undefined -O1 -g'
  cmake -S . -B build-sanitize -G Ninja -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS="$flags" -DSAS_MOTION_BENCHMARKS=OFF >/dev/null
  cmake --build build-sanitize --target core_tests filter_tests pipeline_tests
  (cd build-sanitize/test && ./core_tests --gtest_brief=1 && ./filter_tests --gtest_brief=1 && ./pipeline_tests --gtest_brief=1)
fi
echo "check: all well"
