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

# usage: configure NAME SANITIZERS OPTIMISATION
configure() {
  mkdir -p "$work"
  cmake -S . -B "$work/$1" -G Ninja -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCATKIN_DEVEL_PREFIX="$work/$1/devel" -DCMAKE_BUILD_TYPE=None \
    -DCMAKE_CXX_FLAGS="-fsanitize=$2 -fno-sanitize-recover=all $3 -g1" -DSAS_MOTION_BENCHMARKS=OFF >"$work/$1.log" 2>&1 ||
    fail "CMake could not configure; its log is $work/$1.log"
}

labelled() {  # NAME LABEL: the executables of a build that have a label
  awk -v label="$2" '{ for (i = 2; i <= NF; ++i) if ($i == label) print $1 }' "$work/$1/test/labels.txt"
}

has_label() {  # NAME EXECUTABLE LABEL
  grep -qE "^$2( .*)? $3( |\$)" "$work/$1/test/labels.txt"
}

compile() {  # NAME TARGET...
  local name=$1; shift
  [ $# -gt 0 ] || fail "no executable has the label to be checked; see $work/$name/test/labels.txt"
  cmake --build "$work/$name" -j "$(nproc)" --target "$@" -- --quiet
}

check_address() {
  echo "check: every test and tool under the address and undefined-behaviour sanitizers (about 25 minutes to build on two cores the first time)"
  configure address address,undefined -O1
  local tests tools name leaks
  mapfile -t tests < <(labelled address gtest)
  mapfile -t tools < <(labelled address tool)
  compile address "${tests[@]}" "${tools[@]}"
  for name in "${tests[@]}"; do
    leaks=1
    ! has_label address "$name" ros || leaks=0  # ROS's own libraries leave a few objects behind at exit
    echo "check: $name"
    # verbosity=1 makes the sanitizer tell of each thread, so that no test that starts some escapes check_thread.
    (cd "$work/address/test" && ASAN_OPTIONS=detect_leaks=$leaks:verbosity=1 "./$name" --gtest_brief=1 >"$work/$name.log" 2>&1) ||
      { grep -v '^==[0-9]*==T[0-9]*: ' "$work/$name.log" | tail -n 100; fail "$name failed; its log is $work/$name.log"; }
    ! grep -q '^==[0-9]*==T1: ' "$work/$name.log" || has_label address "$name" threads ||
      fail "$name starts threads: say THREADS of it in test/CMakeLists.txt"
  done
  (set +u; source "$work/address/devel/setup.bash"; ASAN_OPTIONS=detect_leaks=0 /usr/bin/python3 -m pytest -q -p no:cacheprovider test/python/test_tools.py)
}

check_thread() {
  echo "check: every test that starts threads under the thread sanitizer (about 15 minutes to build on two cores the first time)"
  configure thread thread -O2  # the slowest of them: whole campaigns run on two threads
  local tests name
  mapfile -t tests < <(labelled thread threads)
  compile thread "${tests[@]}"
  for name in "${tests[@]}"; do
    echo "check: $name"
    (cd "$work/thread/test" && "./$name" --gtest_brief=1) || fail "$name failed"
  done
}

for step in "$@"; do
  case $step in
    format | tidy | address | thread) "check_$step" ;;
    *) fail "there is no check '$step'; choose of format, tidy, address, thread" ;;
  esac
done
echo "check: all well"
