#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Builds upstream without our hooks, by the compiler and flags of the build that BINARY is of, as
# build/plain/bin/povray: what the hooks cost can be told from nothing else. Silent when it works.
#   plain.sh BINARY      JOBS: compilations at a time (all processors)
set -euo pipefail
cache=$(dirname "$(realpath "$1")")/../CMakeCache.txt
cd "$(dirname "$0")/../.."
plain=$PWD/build/plain
die() { echo "plain: $*" >&2; exit 1; }

[ -f "$cache" ] || die "$1 lies in no CMake build, so its flags are unknown"
same=()
while read -r setting; do same+=("-D$setting"); done < <(
	grep -E '^(CMAKE_(BUILD_TYPE|CXX_COMPILER|CXX_COMPILER_LAUNCHER|CXX_FLAGS|CXX_FLAGS_RELEASE|EXE_LINKER_FLAGS)|POVRAY_(SOURCE|CONFDIR)):' "$cache")
generator=$(sed -n 's/^CMAKE_GENERATOR:INTERNAL=//p' "$cache")
mkdir -p "$plain"
{ cmake -S . -B "$plain" -G "$generator" "${same[@]}" -DPOVRAY_HOOKS=OFF -DBLACKHOLE_TESTS=OFF &&
	cmake --build "$plain" --target povray -j "${JOBS:-$(nproc)}"; } >"$plain/log" 2>&1 ||
	{ tail -n 5 "$plain/log" >&2; die "upstream without hooks does not build (see build/plain/log)"; }
