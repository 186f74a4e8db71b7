#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Where the source and the tools may come from, and the one line that says what is missing. Works on a copy of the
# repository's scripts and hooks, with programs hidden from the PATH; nothing is downloaded or compiled.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
files=$root/build/upstream/download
"$root/tools/upstream" fetch
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/repo"
cp -r "$root"/{tools,source,vfe,unix,cmake,blackhole,distribute,tests,CMakeLists.txt,LICENSE,README.md} "$work/repo"
cd "$work/repo"
bad=0
fail() { echo "FAILED: $*"; bad=1; }

without() { # NAMES... -- COMMAND...: runs it with a PATH that lacks these programs
	local hidden=$work/bin f
	rm -rf "$hidden"; mkdir "$hidden"
	for f in /usr/bin/* /bin/*; do ln -sf "$f" "$hidden/${f##*/}" 2>/dev/null || true; done
	while [ "$1" != -- ]; do rm -f "$hidden/$1"; shift; done
	shift
	PATH=$hidden "$@"
}
stub() { # NAME TEXT: a program of that name that comes first
	mkdir -p "$work/stubs"
	printf '#!/bin/bash\n%s\n' "$2" >"$work/stubs/$1"
	chmod +x "$work/stubs/$1"
}
works() { # WHAT COMMAND...
	local what=$1
	shift
	rm -rf build
	"$@" >"$work/out" 2>&1 || fail "$what: $(head -3 "$work/out")"
	grep -q Bent_Path build/upstream/tree/source/backend/render/trace.cpp || fail "$what: no hooks in the tree"
}
says() { # WHAT EXPRESSION COMMAND...: it fails, and its last line says why
	local what=$1 expression=$2
	shift 2
	if "$@" >"$work/out" 2>&1; then fail "$what: succeeded"; fi
	tail -1 "$work/out" | grep -qE "$expression" || fail "$what: should say '$expression', said: $(cat "$work/out")"
	[ "$(wc -l <"$work/out")" -le 2 ] || fail "$what: more than one line and what was being done: $(cat "$work/out")"
}

# No network: the three files, one of them, or a tree are enough.
stub apt-get 'echo no network >&2; exit 100'
offline() { PATH=$work/stubs:$PATH "$@"; }
works "a folder with the files" offline tools/upstream prepare "$files"
works "the archive, by a relative path" offline tools/upstream prepare "$(realpath --relative-to=. "$files")/povray_3.7.0.10.orig.tar.gz"
works "an unpacked tree" offline tools/upstream prepare "$root/build/upstream/pristine"

mkdir "$work/corrupt"
cp "$files"/povray_* "$work/corrupt"
printf x | dd of="$work/corrupt/povray_3.7.0.10.orig.tar.gz" bs=1 seek=1000 conv=notrunc status=none
rm -rf build
says "a wrong hash" "orig.tar.gz is not Debian's: its SHA-256 must be 7bee83d9" tools/upstream prepare "$work/corrupt"
says "no such source" "no such tree, .dsc or folder" tools/upstream prepare "$work/nowhere"
says "no network" "could not be fetched .* is there a network" offline tools/upstream prepare
mkdir -p build/upstream/download
cp "$work/corrupt"/povray_* build/upstream/download
says "a corrupt download, no network" "could not be fetched .* is there a network" offline tools/upstream prepare

stub id 'echo 1000'
says "not root" "not root: run 'sudo apt-get install ninja-build'" without ninja -- env PATH="$work/stubs:$work/bin" tools/setup
says "no compiler, no apt" "no g\+\+ and no apt-get" without c++ g++ gcc cc apt-get -- tools/setup
[ $bad = 0 ] && echo "sources and messages are as they should be"
exit $bad
