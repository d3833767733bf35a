#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Formatting, lint and sanitizers. usage: scripts/check.sh [format|tidy|address|thread]...; all of them without a word.
# BUILD (default: build) is the folder of the ordinary build, which must be there: it holds the generated messages and the compile commands.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
build=${BUILD:-build}
[ $# -gt 0 ] || set -- format tidy address thread
fail() { echo "check: $*" >&2; exit 1; }

# Outside this folder: ROS searches it for executables and would find each tool twice. Kept, so that the next run builds only what changed.
work=${TMPDIR:-/tmp}/sas_motion-check-$(id -u)-$(cksum <<<"$root" | cut -d ' ' -f 1)

check_format() {
  echo "check: clang-format"
  git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run --Werror || fail "run 'clang-format -i' on these files"
}

tidy_one() {  # prints only what is wrong
  local said
  said=$(clang-tidy -p "$1" --quiet --warnings-as-errors='*' "$2" 2>/dev/null) || { printf '%s\n' "$said"; return 1; }
}
export -f tidy_one

check_tidy() {
  echo "check: clang-tidy (about 10 minutes on two cores)"
  [ -f "$build/CMakeCache.txt" ] || fail "there is no build in $build; run 'make build' first"
  cmake "$build" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON >/dev/null
  git ls-files 'src/*.cpp' | xargs -P "$(nproc)" -I{} bash -c "tidy_one '$build' '{}'" || fail "clang-tidy found the above"
}

# usage: build_with NAME SANITIZERS TARGET...
build_with() {
  local name=$1 sanitizers=$2; shift 2
  mkdir -p "$work"
  cmake -S . -B "$work/$name" -G Ninja -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCATKIN_DEVEL_PREFIX="$work/$name/devel" -DCMAKE_BUILD_TYPE=None \
    -DCMAKE_CXX_FLAGS="-fsanitize=$sanitizers -fno-sanitize-recover=all -O1 -g1" -DSAS_MOTION_BENCHMARKS=OFF >"$work/$name.log" 2>&1 ||
    fail "CMake could not configure; its log is $work/$name.log"
  cmake --build "$work/$name" -j "$(nproc)" --target "$@" -- --quiet
}

check_address() {
  echo "check: tests and tools under the address and undefined-behaviour sanitizers (about 15 minutes to build on two cores the first time)"
  build_with address address,undefined core_tests filter_tests allocation_tests pipeline_tests imaging_tests usbl_tests graph_tests simulate reprocess sas_motion_metrics run_campaign calibrate_usbl focus plan_track
  for tests in core filter allocation pipeline imaging usbl graph; do (cd "$work/address/test" && "./${tests}_tests" --gtest_brief=1); done
  # ROS's own libraries leave a few objects behind at exit.
  (set +u; source "$work/address/devel/setup.bash"; ASAN_OPTIONS=detect_leaks=0 /usr/bin/python3 -m pytest -q -p no:cacheprovider test/python/test_tools.py)
}

check_thread() {
  echo "check: what runs on threads under the thread sanitizer"
  build_with thread thread core_tests pipeline_tests
  (cd "$work/thread/test" && ./core_tests --gtest_brief=1 --gtest_filter='BackgroundFile*:CpuTime*' &&
    ./pipeline_tests --gtest_brief=1 --gtest_filter='OrderedTasks*:TowfishSystem.ALaw*')
}

for step in "$@"; do
  case $step in
    format | tidy | address | thread) "check_$step" ;;
    *) fail "there is no check '$step'; choose of format, tidy, address, thread" ;;
  esac
done
echo "check: all well"
