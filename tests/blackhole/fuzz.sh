#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Builds fuzz.cpp with clang's libFuzzer and sanitizers, and lets it run.
#   fuzz.sh BUILD SECONDS [libFuzzer's options...]
# The corpus and what failed stay in BUILD/fuzz (the smoke run, of 15 seconds or less, starts from nothing). Exit code 77: no clang.
set -euo pipefail
build=$1 seconds=$2
shift 2
cd "$(dirname "$0")/../.."
mkdir -p "$build/fuzz/corpus" "$build/fuzz/failed"
fuzz=$build/fuzz/fuzz
if ! command -v clang++ >/dev/null || ! echo 'extern "C" int LLVMFuzzerTestOneInput(const char*, unsigned long) { return 0; }' |
	clang++ -fsanitize=fuzzer,address,undefined -x c++ - -o "$build/fuzz/probe" 2>/dev/null; then
	echo "fuzz: skipped: no clang++ with libFuzzer here (Debian: clang and libclang-rt-dev)"
	exit 77
fi
sources=(blackhole/*.cpp tests/blackhole/{extremes,extreme_checks,extreme_rays,extreme_routes,fuzz}.cpp)
if [ ! -x "$fuzz" ] || [ -n "$(find blackhole tests/blackhole -newer "$fuzz" -name '*.[ch]*')" ]; then
	clang++ -std=gnu++17 -O1 -g1 -ffp-contract=off -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all \
		-I. -Itests/blackhole "${sources[@]}" -o "$fuzz.$$"
	mv "$fuzz.$$" "$fuzz"
fi
corpus=()
[ "$seconds" -le 15 ] || corpus=("$build/fuzz/corpus")
# A ray takes a millisecond at most, a hundred with the sanitizers: one that takes 200 s does not end, however busy the machine.
exec "$fuzz" -max_total_time="$seconds" -max_len=80 -timeout=200 -error_exitcode=1 -print_final_stats=1 -verbosity=0 \
	-artifact_prefix="$build/fuzz/failed/" "$@" "${corpus[@]}"
