#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# A scene without a hole must not change by a bit: renders Debian's sample scenes with Debian's povray and
# with BINARY, and compares the pictures, 16 bits a channel.
#   stock.sh BINARY         the spread of scenes in stock-scenes.txt
#   stock.sh BINARY --all   every scene that Debian's povray renders within two minutes
# Debian's pictures are kept in build/upstream/stock-pictures. Where BINARY's differ both are left in
# ./stock-different. JOBS (2) scenes at a time, as povray sleeps for most of a small picture.
set -euo pipefail
binary=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
[ -x "$binary" ] || { echo "stock: no program $binary" >&2; exit 1; }
"$root/tools/stock"

work=$(mktemp -d)
trap '[ -z "${renders:-}" ] || kill -- -$renders 2>/dev/null || true; rm -rf "$work"' EXIT
trap 'exit 1' INT TERM
# povray's command line has no words for a path with spaces, which the repository's may be.
ln -s "$root/build/upstream/stock" "$work/stock"
export work binary stock=$work/stock cache=$root/build/upstream/stock-pictures left=$PWD/stock-different
export examples=$stock/usr/share/doc/povray/examples width=80 height=60 options="+WT1 -D -A +FP16 -GA"
# No settings of the user's or the machine's own; a home that a restricted povray.conf lets be read.
export POVINI=$work/none.ini HOME=$root/build/upstream/stock
touch "$POVINI"
"$stock/usr/bin/povray" --version >"$work/log" 2>&1 || { echo "stock: Debian's povray does not start: $(tail -n1 "$work/log")" >&2; exit 1; }

key="$(cat "$stock/stamp") $width x $height $options, frame 2"
if [ "$(cat "$cache/key" 2>/dev/null)" != "$key" ]; then
	rm -rf "$cache"; mkdir -p "$cache"; echo "$key" >"$cache/key"
fi

render() { # BINARY SCENE SECONDS PIXELS LOG: each in a folder of its own, as some scenes write files
	local folder frame="" status=0
	folder=$(mktemp -d -p "$work")
	# Of a series by frame_number, which is 0 outside an animation: the second of three.
	! grep -q frame_number "$examples/$2" || frame="+KFI1 +KFF3 +SF2 +EF2"
	# The braces: bash's own word about a crash belongs to the log.
	# On a busy machine a thread may not begin in the three seconds that POV-Ray gives it: then once more.
	for try in {1..20}; do
		status=0
		{ (cd "$folder" && timeout --foreground -k 5 "$3" "$1" "+I$examples/$2" "+L$examples/$(dirname "$2")" "+L$stock/usr/share/povray-3.7/include" \
			"+W$width" "+H$height" $options $frame +Opicture.ppm); } >"$5" 2>&1 </dev/null || status=$?
		[ $status != 0 ] && grep -aq 'Timed out waiting for worker thread startup' "$5" || break
	done
	# The header names the program's version, the pixels do not.
	[ $status != 0 ] || tail -qc $((width * height * 6)) "$folder"/picture*.ppm >"$4" 2>/dev/null || status=1
	rm -rf "$folder"
	return $status
}

complaint() { (grep -aoiE -m1 '(fatal|parse) error.*|segmentation fault|aborted|terminate called.*' "$1" || tail -n1 "$1") | tr -d '\r' | cut -c1-150; }

compare() { # SCENE: one line, its first word identical, different, failed, or without (Debian's own povray fails)
	local scene=$1 name status=0 pixels log
	name=${scene//\//_} pixels=$(mktemp -p "$work") log=$(mktemp -p "$work")
	if [ ! -f "$cache/$name" ] && [ ! -f "$cache/$name.without" ]; then
		render "$stock/usr/bin/povray" "$scene" $patience "$pixels" "$log" || status=$?
		if [ $status = 0 ]; then mv "$pixels" "$cache/$name"
		else echo "exit $status $(complaint "$log")" >"$cache/$name.without"; fi
	fi
	if [ -f "$cache/$name.without" ]; then echo "without $scene: Debian's povray: $(cat "$cache/$name.without")"; return; fi
	status=0
	render "$binary" "$scene" $((2 * patience)) "$pixels" "$log" || status=$?
	if [ $status != 0 ]; then echo "failed $scene: exit $status $(complaint "$log")"
	elif cmp -s "$cache/$name" "$pixels"; then echo "identical $scene"
	else
		mkdir -p "$left"
		for picture in "$cache/$name" "$pixels"; do
			{ printf 'P6\n%d %d\n65535\n' $width $height; cat "$picture"; } >"$left/${name%.pov}.$([ "$picture" = "$pixels" ] && echo ours || echo stock).ppm"
		done
		# cmp counts bytes from 1 and prints them in octal; of a channel's two bytes the first is what one sees.
		echo "different $scene: $(cmp -l "$cache/$name" "$pixels" | awk '
			function octal(o) { return int(o / 100) * 64 + int(o / 10) % 10 * 8 + o % 10 }
			!seen[int(($1 - 1) / 6)]++ { n++ }
			$1 % 2 { d = octal($2) - octal($3); if (d < 0) d = -d; if (d > most) most = d }
			END { printf "%d pixels, by up to %d/255", n, most }')"
	fi
	rm -f "$pixels" "$log"
}
# The spread's scenes take a second: what is merely slow or busy comes to no end there.
patience=120
[ "${2:-}" = --all ] || patience=400
export patience
export -f render complaint compare

words() { sed 's/[[:space:]].*//; /^#/d; /^$/d' "$1"; }
if [ "${2:-}" = --all ]; then
	required=111
	(cd "$examples" && find . -name '*.pov' | sed 's|^\./||' | sort) | grep -vxFf <(words "$here/stock-excluded.txt") >"$work/scenes"
else
	words "$here/stock-scenes.txt" >"$work/scenes"
	required=40
fi
# A process group of its own, so that stopping the test stops the renders.
set -m
xargs -P "${JOBS:-2}" -d '\n' -n1 bash -c 'compare "$1"' - <"$work/scenes" >"$work/results" &
renders=$!
set +m
wait $renders || true
renders=
sort "$work/results" | grep -vE '^(identical|without) ' || true
count() { grep -c "^$1 " "$work/results" || true; }
if [ "${2:-}" = --all ]; then echo "(not compared: $(count without) scenes that Debian's own povray cannot render, $(words "$here/stock-excluded.txt" | wc -l) excluded)"
else grep '^without ' "$work/results" || true; fi
# A scene without a line in the results is one whose comparison itself broke.
identical=$(count identical) different=$(count different)
failed=$(($(wc -l <"$work/scenes") - identical - different - $(count without)))
echo "$identical identical, $different different, $failed failed"
[ "$different$failed" = 00 ] && [ "$identical" -ge $required ]
