#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Measures what docs/results.md claims. usage: scripts/bench.sh; expects the devel space sourced. SMOKE=1: the smallest size.
# Ratios are of runs side by side; quote those, not the times, of a shared machine.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
tools=$(catkin_find --first-only --libexec sas_motion)
out=${OUT_DIR:-$root/bench}
smoke=${SMOKE:-0}
mkdir -p "$out"
nodes=100000 seconds=3600
[ "$smoke" = 0 ] || { nodes=1000 seconds=60; }

campaign() {  # SUITE RUNS
  echo "bench: suite $1 ($2 seeds)"
  "$tools/benchmark" "$root/config/suites/$1.yaml" -o "$out/$1" --runs "$2" --fresh | tee "$out/$1.txt"
  echo
}
if [ "$smoke" = 1 ]; then
  campaign smoke 2
else
  campaign accuracy 100   # the paper's case
  campaign cauchy 100     # the smoother with a redescending loss
  campaign smoothers 10   # rts beside batch
  campaign survey 100     # the asynchronous survey
  campaign eight_laws 1000
  campaign asynchronous 100
  campaign imaging 20     # the image as judge
  campaign usbl 100
  campaign usbl_lock_in 1000
fi

echo "bench: predict and update of all four channels"
"$tools/filter_speed" --benchmark_repetitions=5 --benchmark_report_aggregates_only=true --benchmark_out="$out/filters.json" --benchmark_out_format=json >/dev/null 2>&1
venv="$root/.venv"
[ -x "$venv/bin/python" ] || /usr/bin/python3 -m venv "$venv"
"$venv/bin/python" -c 'import filterpy' 2>/dev/null || "$venv/bin/pip" install --quiet filterpy==1.4.5 || echo "bench: filterpy could not be installed"
"$venv/bin/python" "$root/benchmark/compare_filters.py" "$out/filters.json"

echo; echo "bench: USBL calibration: an update of each filter, and the batch"
"$tools/usbl_speed" --benchmark_repetitions=5 --benchmark_report_aggregates_only=true
echo; echo "bench: USBL calibration: how the noise is followed, and a circle that tells too little"
"$tools/usbl_figures" $((smoke == 1 ? 3 : 300))

if [ -x "$tools/particle_speed" ]; then
  echo; echo "bench: particle filters of SINS and DVL, with and without vector instructions"
  size=(40 1200)
  [ "$smoke" = 0 ] || size=(2 48)
  "$tools/particle_speed" "$root/config" "${size[@]}"
fi

if [ -x "$tools/backprojection_speed" ]; then
  echo; echo "bench: backprojection, by vector instructions, beside a plain loop in double; and factorised"
  "$tools/backprojection_speed" $((smoke == 1 ? 1 : 20))
  echo; echo "bench: micronavigation, errors beside its standard deviations"
  "$tools/micronavigation_accuracy" $((smoke == 1 ? 2 : 24))
  echo; echo "bench: navigation, echoes and image in a loop"
  size=(3 20 600)
  [ "$smoke" = 0 ] || size=(1 8 150)
  "$tools/closed_loop" "$root/config" "${size[@]}"
fi

echo; echo "bench: rts beside batch"
"$tools/smoother_speed" "$nodes"

echo; echo "bench: reprocess beside a bare pass over the bag, and memory against the bag's length"
/usr/bin/python3 "$root/benchmark/bag_speed.py" "$tools" "$root/config/scenarios/lawnmower_hour.yaml" "$out" "$seconds"

echo; echo "bench: nodelet, callback to publication at 100 messages a second"
/usr/bin/python3 "$root/benchmark/nodelet_latency.py" "$tools" "$out" $((smoke == 1 ? 20 : 60))

# Other people's code. Without a network what is installed serves and the rest is named; only a smoke run ends well then.
missing=0
install() { env -u PYTHONPATH "$venv/bin/pip" install --quiet --disable-pip-version-check --retries 1 "$@" || missing=1; }
python="$venv/bin/python"
with_peers() { env -u PYTHONPATH FASTSAR_CACHE_DIR="$venv/fastsar" "$python" "$@"; }

echo; echo "bench: our answers and other people's code's"
install -r "$root/benchmark/peers/requirements.txt"
if [ $missing = 0 ]; then
  with_peers "$root/benchmark/cross_check.py" "$tools" $((smoke == 1 ? 20 : 200)) $((smoke == 1 ? 50 : 200))
  echo; echo "bench: our bootstrap filter beside Stone Soup's: answers of many seeds, and time"
  runs=100 particles=(100 1000 10000)
  [ "$smoke" = 0 ] || { runs=20 particles=(100 1000); }
  with_peers "$root/benchmark/compare_particles.py" "$tools" "$runs" "${particles[@]}"
else
  echo "bench: NOT CHECKED by other people's code: benchmark/peers/requirements.txt could not be installed" >&2
fi

with_imaging_peers() {  # exit status 2: a peer is not there, and the rest is measured
  with_peers "$@" || { [ $? = 2 ] && [ $missing = 1 ]; }
}
if [ -x "$tools/backprojection_answers" ]; then
  echo; echo "bench: backprojection beside NumPy's and FastSAR's on one core, and measures of a point target beside perseo-quality's"
  install --no-deps -r "$root/benchmark/peers/requirements_imaging.txt"
  "$python" -c 'import numpy' 2>/dev/null || python=/usr/bin/python3
  smallest=() ideal=()
  [ "$smoke" = 0 ] || { smallest=(64 128 128 3) ideal=(unweighted); }
  with_imaging_peers "$root/benchmark/compare_backprojection.py" "$tools" "${smallest[@]}"
  with_imaging_peers "$root/benchmark/compare_measures.py" "$tools" "${ideal[@]}"
fi
[ $missing = 0 ] || [ "$smoke" = 1 ] || exit 1
