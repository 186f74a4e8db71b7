#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Scenes without a hole must not pay for one: counts BINARY's instructions against those of the same source
# without our hooks, built alike (plain.sh). Fails if one of the scenes costs over 0.3 % more.
#   instructions.sh BINARY
# Counted is what runs inside TraceTask::Run, for each ray: not the parsing, whose share would hide the cost of
# the rays, nor the threads that poll, whose count is never twice the same. So counted, one render is within a
# millionth of the next, and a single one of each is enough.
set -euo pipefail
binary=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
most=0.3
die() { echo "instructions: $*" >&2; exit 1; }

command -v valgrind >/dev/null || die "valgrind is not installed"
"$root/tools/stock"
"$here/plain.sh" "$binary"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
# As in stock.sh: a path without spaces, no settings of the machine's own.
ln -s "$root/build/upstream/stock" stock
stock=$work/stock
examples=$stock/usr/share/doc/povray/examples
export POVINI=$work/none.ini HOME=$root/build/upstream/stock
touch "$POVINI"

count() { # BINARY SCENE
	local try # on a busy machine a thread may not begin in the three seconds that POV-Ray gives it, the less so under valgrind: then once more
	for try in {1..20}; do
		valgrind --tool=callgrind --callgrind-out-file=/dev/null '--toggle-collect=pov::TraceTask::Run()' "$1" \
			"+I$examples/$2" "+L$examples/$(dirname "$2")" "+L$stock/usr/share/povray-3.7/include" \
			+W60 +H45 +WT1 -D -A -F -GA >log 2>&1 && break
		grep -aq 'Timed out waiting for worker thread startup' log || die "$1 does not render $2: $(grep -am1 -iE 'error' log)"
	done
	sed -n 's/.*Collected : \([0-9]*\)$/\1/p' log | grep -v '^0$' || die "$1 has no symbols: nothing was counted in $2"
}

bad=0
# Many objects in CSG; media, with light at every sample; and every kind of primitive. A ray that meets next to nothing
# (a bare sky: 2,000 instructions) pays the same few instructions, which are then over a hundredth of it.
for scene in advanced/chess2.pov interior/media/media1.pov objects/primitiv.pov; do
	plain=$(count "$root/build/plain/bin/povray" $scene)
	ours=$(count "$binary" $scene)
	awk -v p="$plain" -v o="$ours" -v most=$most -v s=$scene 'BEGIN {
		more = 100 * (o / p - 1); printf "%+.3f %%  %s: %.1f million, upstream %.1f; %+.0f a pixel\n", more, s, o / 1e6, p / 1e6, (o - p) / 60 / 45; exit more > most }' || bad=1
done
[ $bad = 0 ] || die "more than $most % above upstream"
