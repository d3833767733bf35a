#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs every test and prints one closing line of counts. usage: scripts/run_tests.sh BUILD_DIR; expects the devel space sourced.
set -uo pipefail
build=${1:?usage: run_tests.sh BUILD_DIR}
root=$(cd "$(dirname "$0")/.." && pwd)
passed=0 failed=0 skipped=0
count() { grep -oE "[0-9]+ $1" "$2" | tail -n 1 | grep -oE '^[0-9]+' || echo 0; }

# evo checks our TUM files and RMSE by other people's code, in an environment of its own.
venv="$root/.venv"
if [ ! -x "$venv/bin/evo_ape" ]; then
  echo "test: installing evo into .venv"
  /usr/bin/python3 -m venv "$venv" && "$venv/bin/pip" install --quiet 'evo==1.38.1' || echo "test: evo could not be installed; its test will fail" >&2
fi
export EVO_APE="$venv/bin/evo_ape" EVO_CONFIG_DIR="$venv" MPLBACKEND=Agg

log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "test: C++"
ctest --test-dir "$build" --output-on-failure -j "$(nproc)" 2>&1 | tee "$log"
all=$(grep -oE 'out of [0-9]+' "$log" | tail -n 1 | grep -oE '[0-9]+' || echo 0)
bad=$(grep -oE '[0-9]+ tests? failed out of' "$log" | grep -oE '^[0-9]+' || echo 1)
passed=$((passed + all - bad)) failed=$((failed + bad))
[ "$all" -gt 0 ] || failed=$((failed + 1))

run_pytest() {  # ARGUMENTS
  /usr/bin/python3 -m pytest -q -p no:cacheprovider "$@" 2>&1 | tee "$log"
  local status=${PIPESTATUS[0]}
  passed=$((passed + $(count passed "$log"))) failed=$((failed + $(count failed "$log") + $(count error "$log"))) skipped=$((skipped + $(count skipped "$log")))
  [ "$status" -eq 0 ] || [ "$failed" -gt 0 ] || failed=1
}
side_by_side=""
/usr/bin/python3 -c 'import xdist' 2>/dev/null && side_by_side="-n $(nproc) --dist loadfile"
echo "test: Python and the tools"
# shellcheck disable=SC2086
run_pytest $side_by_side "$root/test/python"
echo "test: ROS, one after the other: its tests are live"
run_pytest "$root/test/ros"

echo "test: every benchmark once, at its smallest size"
figures=$(mktemp -d)
if SMOKE=1 OUT_DIR="$figures" "$root/scripts/bench.sh" >"$log" 2>&1; then
  passed=$((passed + 1))
else
  tail -n 20 "$log"
  failed=$((failed + 1))
fi
rm -rf "$figures"

echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
