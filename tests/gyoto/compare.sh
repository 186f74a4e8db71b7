#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# The same sky by GYOTO and by us, pixel by pixel: compare.sh POVRAY OUTDIR
# Leaves OUTDIR/beside.png. 0: they agree; 1: they do not; 77: there is no GYOTO here (root: it is installed, from Debian).
set -euo pipefail
[ $# = 2 ] || { sed -n '3,4s/^# //p' "$0" >&2; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
povray=$1
mkdir -p "$2"
out=$(cd "$2" && pwd)
skip() { echo "compare.sh: skipped: $*"; exit 77; }

have() { pkg-config --exists gyoto 2>/dev/null; }
cxx=${CXX:-c++}
command -v "$cxx" >/dev/null || skip "no C++ compiler '$cxx' to build rays.cpp with"
if ! have; then
	{ [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; } ||
		skip "GYOTO's headers are not installed (Debian: libgyoto8-dev); as root on Debian this would install them"
	# The library's version is in the package's name: libgyoto8-dev on Debian 12.
	package() { apt-cache search --names-only '^libgyoto[0-9]+-dev$' 2>/dev/null | sort -V | tail -n 1 | cut -d' ' -f1; }
	name=$(package)
	if [ -z "$name" ]; then
		apt-get update >"$out/apt.log" 2>&1 || true
		name=$(package)
	fi
	[ -n "$name" ] || skip "apt knows no libgyoto*-dev"
	DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=120 install -y --no-install-recommends "$name" >"$out/apt.log" 2>&1 ||
		skip "apt-get could not install $name: $(grep -m 1 '^E:' "$out/apt.log" || echo "see $out/apt.log")"
	have || skip "$name came without gyoto.pc"
fi

if [ ! -x "$out/rays" ] || [ "$here/rays.cpp" -nt "$out/rays" ]; then
	# Not pkg-config --libs: it names what a static link needs, flint's development package for one.
	# shellcheck disable=SC2046
	"$cxx" -std=c++17 -O2 $(pkg-config --cflags gyoto) "$here/rays.cpp" -lgyoto -o "$out/rays"
fi
exec python3 "$here/compare.py" "$povray" "$out/rays" "$out"
