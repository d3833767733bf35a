#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what sas_motion needs to build and run: Debian packages, then GTSAM. Does nothing where all is there.
# usage: scripts/setup.sh [EXTRA_PACKAGE...]
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
fail() { echo "setup: $*" >&2; exit 1; }

if [ -r /opt/ros/noetic/setup.bash ]; then
  echo "setup: ROS Noetic found under /opt/ros; install this package's dependencies with 'rosdep install --from-paths . -y'"
  exit 0
fi
command -v apt-get >/dev/null || fail "this machine has no apt-get; install the packages of scripts/packages.txt by your own means, then run again"

mapfile -t wanted < <(grep -v '^#' "$here/packages.txt"; printf '%s\n' "$@")
missing=()
for package in "${wanted[@]}"; do
  [ -z "$package" ] && continue
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done

if [ ${#missing[@]} -gt 0 ]; then
  [ "$(id -u)" -eq 0 ] || fail "${#missing[@]} packages are missing and only root can install them; run this as root, or install: ${missing[*]}"
  free_mib=$(df --output=avail -m / | tail -n 1)
  [ "$free_mib" -ge 6000 ] || fail "6 GB of disk are needed below / and only $free_mib MB are free"
  log=$(mktemp)
  echo "setup: installing ${#missing[@]} Debian packages (about 3 minutes the first time; log: $log)"
  apt-get update -qq >"$log" 2>&1 || true
  DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}" >>"$log" 2>&1 ||
    fail "apt-get could not install the packages; is there a network? The last lines of $log: $(tail -n 2 "$log" | tr '\n' ' ')"
fi
"$here/build_gtsam.sh"
