#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The whole comparison: simulates a bag with outliers, plays it through the nodelets, evaluates their answers against truth.
# usage: scripts/compare.sh OUT_DIR [SCENARIO.yaml] [RATE]; expects the package on ROS's path (devel or install space sourced).
set -euo pipefail
out=${1:?usage: compare.sh OUT_DIR [SCENARIO.yaml] [RATE]}
fail() { echo "compare: $*" >&2; exit 1; }
package=$(rospack find sas_motion 2>/dev/null) || fail "ROS does not find sas_motion; source build/devel/setup.bash first"
tools=$(catkin_find --first-only --libexec sas_motion)
scenario=${2:-$package/config/scenarios/survey_outliers_10.yaml}
rate=${3:-20}
mkdir -p "$out" && out=$(cd "$out" && pwd)

port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
export ROS_IP=127.0.0.1 ROS_MASTER_URI="http://127.0.0.1:$port" ROS_HOME="$out/ros"
unset ROS_HOSTNAME

echo "compare: simulating $(basename "$scenario")"
"$tools/simulate" "$scenario" -o "$out/simulated.bag"
echo "compare: playing it through the filter nodelet and the smoother nodelet at $rate times real time"
rm -f "$out/live.bag" "$out/live.bag.active"
roslaunch --port "$port" sas_motion compare.launch bag:="$out/simulated.bag" output:="$out/live.bag" rate:="$rate" >"$out/launch.log" 2>&1 ||
  { tail -n 20 "$out/launch.log" >&2; fail "the launch failed; its log is $out/launch.log"; }
[ -s "$out/live.bag" ] || { tail -n 20 "$out/launch.log" >&2; fail "nothing was recorded; the launch's log is $out/launch.log"; }
grep -h 'play_session:' "$out/launch.log" | sed 's/^play_session/compare/' || true
echo "compare: evaluating against truth"
"$tools/evaluate.py" "$out/live.bag" -o "$out"
