#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Installs into a folder of its own, runs what was installed as a user would, takes it away again.
#   install.sh BUILD
set -euo pipefail
build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"; [ ! -f "$work.manifest" ] || mv "$work.manifest" "$build/install_manifest.txt"' EXIT
fail() { echo "FAILED: $*"; exit 1; }
# A manifest of the user's own installation is not ours to lose.
[ ! -f "$build/install_manifest.txt" ] || cp "$build/install_manifest.txt" "$work.manifest"

mkdir "$work/other"
printf '#!/bin/sh\n' >"$work/other/povray"
chmod +x "$work/other/povray"
PATH=$work/other:$PATH DESTDIR=$work/to cmake --install "$build" >"$work/out" 2>&1
tr -s '\n ' ' ' <"$work/out" | grep -q "There is another povray, $work/other/povray" || fail "no warning of a povray that shadows this one"

share=$(find "$work/to" -name colors.inc -printf '%h')
[ -n "$share" ] || fail "no includes"
[ -f "$share/../scenes/blackhole/first_light.pov" ] || fail "no scenes"
[ -f "$share/blackhole.inc" ] || fail "blackhole.inc is not beside POV-Ray's own includes"
mkdir -p "$work/home/.povray/3.7"
printf 'Width=40\nHeight=30\nLibrary_Path="%s"\n' "$share" >"$work/home/.povray/3.7/povray.ini"
cd "$work"
printf '#version 3.7; #include "colors.inc"\n#include "blackhole.inc"\nglobal_settings { assumed_gamma 1 } sphere { z, 0.5 pigment { Red } } blackhole { <3, 0, 5>, 1 }' >scene.pov
HOME=$work/home "$(find "$work/to" -name povray -type f -perm -1)" +Iscene.pov -D >out 2>&1 || fail "$(tail -3 out)"
grep -q 'Image resolution.....40 by 30' out || fail "the user's povray.ini was not read"
[ -f scene.png ] || fail "no picture"
HOME=$work/home "$(find "$work/to" -name bhtrade -type f -perm -1)" scene.pov >out 2>&1 || fail "bhtrade: $(tail -3 out)"
grep -q 'scene.pov, 40 x 30: errors in pixels' out || fail "bhtrade says: $(head -3 out)"

DESTDIR=$work/to cmake --build "$build" --target uninstall >/dev/null
[ -z "$(find "$work/to" -type f)" ] || fail "left behind: $(find "$work/to" -type f | head -3)"
echo "installs, runs and uninstalls"
