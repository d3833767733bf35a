#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds GTSAM 4.2 with gtsam_unstable from Debian's source and installs it under GTSAM_PREFIX (default /usr/local), once for every
# checkout of this machine. Does nothing where CMake already finds it.
set -euo pipefail
prefix=${GTSAM_PREFIX:-/usr/local}
sha256=8383cc1fe7ea82549c9cd6c0cead48712d3348f4193c0c16e776e57401343277
fail() { echo "build_gtsam: $*" >&2; exit 1; }

found() {
  local probe; probe=$(mktemp -d)
  printf 'cmake_minimum_required(VERSION 3.16)\nproject(probe CXX)\nfind_package(GTSAM 4 REQUIRED)\nfind_package(GTSAM_UNSTABLE REQUIRED)\n' >"$probe/CMakeLists.txt"
  local status=0
  cmake -S "$probe" -B "$probe/build" -DCMAKE_PREFIX_PATH="$prefix" >/dev/null 2>&1 || status=1
  rm -rf "$probe"
  return $status
}

found && exit 0
mkdir -p "$prefix" 2>/dev/null && [ -w "$prefix" ] || fail "cannot write to $prefix; run as root or set GTSAM_PREFIX to a folder of yours"
exec 9>"${TMPDIR:-/tmp}/sas_motion-gtsam.lock"
flock -n 9 || { echo "build_gtsam: another run is building GTSAM; waiting for it"; flock 9; }
found && exit 0

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
free_mib=$(df --output=avail -m "$work" | tail -n 1)
[ "$free_mib" -ge 3000 ] || fail "3 GB of disk are needed below $work and only $free_mib MB are free"

echo "build_gtsam: fetching the source of GTSAM 4.2 (11 MB)"
# A private source list: the machine's own archive and keyring, Debian 13's sources, nothing of the machine's configuration changed.
archive=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | grep -E -m 1 '/debian/?$') ||
  fail "no Debian archive among this machine's apt sources"
keyring=/usr/share/keyrings/debian-archive-keyring.gpg
echo "deb-src [signed-by=$keyring] $archive trixie main" >"$work/sources.list"
mkdir -p "$work/lists/partial"
apt=(apt-get -o "Dir::Etc::SourceList=$work/sources.list" -o Dir::Etc::SourceParts=- -o "Dir::State::Lists=$work/lists" -o APT::Sandbox::User=root)
unreachable() { fail "$1 could not be fetched from $archive; is there a network? $(tail -n 1 "$work/apt.log")"; }
# By itself apt-get takes an archive that does not answer for a warning.
"${apt[@]}" update -qq -o APT::Update::Error-Mode=any >"$work/apt.log" 2>&1 || unreachable "the list of Debian 13's sources"
(cd "$work" && "${apt[@]}" source --tar-only --download-only gtsam/trixie >>"$work/apt.log" 2>&1) || unreachable "GTSAM's source"
tarball=$(find "$work" -maxdepth 1 -name 'gtsam_4.2*orig.tar.xz')
[ -n "$tarball" ] || fail "$archive has another version of GTSAM than 4.2"
echo "$sha256  $tarball" | sha256sum --status -c || fail "GTSAM's source from $archive has a wrong checksum"
mkdir "$work/src"
tar -xf "$tarball" -C "$work/src" --strip-components 1

# Debian's tarball has no third-party code: take Debian's own ccolamd, and leave out Shonan averaging, which needs an older Spectra.
cd "$work/src/gtsam"
mkdir -p 3rdparty && : >3rdparty/CMakeLists.txt
python3 - <<'PY'
import re
text = open('CMakeLists.txt').read()
def edit(pattern, replacement):
    global text
    text, count = re.subn(pattern, replacement, text, flags=re.S)
    assert count, f'GTSAM\'s CMakeLists.txt has changed: {pattern}'
edit(r'set \(3rdparty_srcs.*?SuiteSparse_config\.c\)', 'set(3rdparty_srcs)')
edit(r'("\$\{CMAKE_CURRENT_SOURCE_DIR\}/slam/serialization\.cpp")', r'\1 "${CMAKE_CURRENT_SOURCE_DIR}/sfm/ShonanAveraging.cpp"')
edit(r'[^\n]*INSTALL_INTERFACE:include/gtsam/3rdparty/[^\n]*\n', '')
text += '''
target_link_libraries(gtsam PRIVATE ccolamd suitesparseconfig)
set_source_files_properties(linear/GaussianConditional.cpp nonlinear/GaussNewtonOptimizer.cpp nonlinear/NonlinearConjugateGradientOptimizer.cpp
  PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
'''
open('CMakeLists.txt', 'w').write(text)
PY
sed -i -E 's#<(gtsam/)?3rdparty/CCOLAMD/Include/ccolamd.h>|"ccolamd.h"|<ccolamd.h>#<suitesparse/ccolamd.h>#' inference/Ordering.cpp

jobs=$(nproc)
echo "build_gtsam: building GTSAM with $jobs jobs (about $((17 / jobs + 1)) minutes, once for this machine)"
cmake -S "$work/src" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$prefix" \
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12 -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG" \
  -DGTSAM_USE_SYSTEM_EIGEN=ON -DGTSAM_USE_SYSTEM_METIS=ON -DGTSAM_BUILD_WITH_MARCH_NATIVE=OFF -DGTSAM_WITH_TBB=OFF \
  -DGTSAM_BUILD_PYTHON=OFF -DGTSAM_BUILD_TESTS=OFF -DGTSAM_BUILD_EXAMPLES_ALWAYS=OFF -DGTSAM_BUILD_TIMING_ALWAYS=OFF \
  -DGTSAM_BUILD_UNSTABLE=ON >"$work/configure.log" 2>&1 || { tail -n 20 "$work/configure.log" >&2; fail "GTSAM could not be configured"; }
if [ -t 1 ]; then
  cmake --build "$work/build" -j "$jobs" || fail "GTSAM did not build"
else
  cmake --build "$work/build" -j "$jobs" 2>&1 | while IFS= read -r line; do
    case $line in *error*|*FAILED*) echo "$line" ;; esac
    [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]] || continue
    tenth=$((10 * BASH_REMATCH[1] / BASH_REMATCH[2]))
    [ "$tenth" -gt "${last:-0}" ] && last=$tenth && echo "build_gtsam: ${tenth}0 %"
  done
  [ "${PIPESTATUS[0]}" -eq 0 ] || fail "GTSAM did not build"
fi
cmake --install "$work/build" >/dev/null
ldconfig 2>/dev/null || true
found || fail "GTSAM was installed under $prefix but CMake does not find it; set CMAKE_PREFIX_PATH=$prefix"
echo "build_gtsam: GTSAM 4.2 is installed under $prefix"
