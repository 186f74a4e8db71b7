#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Fuzzes what the farm takes from strangers, by clang's libFuzzer with AddressSanitizer and UndefinedBehaviorSanitizer.
#   fuzz.sh BUILD SECONDS [libFuzzer's options...]
# Starts from the good inputs of BUILD/bin/farm_fuzz; the corpus and what failed stay in BUILD/fuzz-farm. Exit code 77: no clang.
set -euo pipefail
build=$(realpath "$1") seconds=$2
shift 2
cd "$(dirname "$0")/../.."
work=$build/fuzz-farm fuzz=$build/fuzz-farm/fuzz
mkdir -p "$work/corpus" "$work/failed" "$work/objects"
if ! command -v clang++ >/dev/null || ! echo 'extern "C" int LLVMFuzzerTestOneInput(const char*, unsigned long) { return 0; }' |
	clang++ -fsanitize=fuzzer,address,undefined -x c++ - -o "$work/probe" 2>/dev/null; then
	echo "fuzz: skipped: no clang++ with libFuzzer here (Debian: clang and libclang-rt-dev)"
	exit 77
fi
sources=(distribute/common/{error,files,hash}.cpp distribute/protocol/*.cpp distribute/http/{door,router}.cpp distribute/scene/{ini,switches}.cpp
	distribute/stitch/{exr,picture,png,png_filter,png_join}.cpp tests/distribute/fuzz.cpp)
if [ ! -x "$fuzz" ] || [ -n "$(find distribute tests/distribute -newer "$fuzz" -name '*.[ch]*')" ]; then
	# Clang 14 has C++20's coroutines, which Boost 1.74 does not know of.
	flags=(-std=c++20 -O1 -g1 -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all -I. -DBOOST_ASIO_HAS_CO_AWAIT -DBOOST_ASIO_HAS_STD_COROUTINE
		$(pkg-config --cflags OpenEXR) -include utility)
	rm -f "$work"/objects/*.o
	printf '%s\n' "${sources[@]}" | xargs -P 2 -I{} sh -c 'clang++ "$@" -c {} -o "$0/$(echo {} | tr / _).o"' "$work/objects" "${flags[@]}"
	clang++ "${flags[@]}" "$work"/objects/*.o $(pkg-config --libs OpenEXR libpng zlib libcrypto) -o "$fuzz.$$"
	mv "$fuzz.$$" "$fuzz"
fi
"$build/bin/farm_fuzz" --write "$work/corpus"
cd "$work"
exec "$fuzz" -max_total_time="$seconds" -max_len=4096 -timeout=20 -rss_limit_mb=1024 -error_exitcode=1 -print_final_stats=1 -verbosity=0 \
	-artifact_prefix="$work/failed/" "$@" "$work/corpus"
