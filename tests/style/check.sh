#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# The house's rules that a machine can check.
#   check.sh format|tidy|licence|layers BUILD
set -euo pipefail
cd "$(dirname "$0")/../.."
files() { find "$@" -name '*.cpp' -o -name '*.h' | sort; }
die() { echo "style: $*" >&2; exit 1; }
case $1 in
format) files blackhole distribute tests | xargs clang-format --dry-run -Werror ;;
tidy) clang-tidy --quiet -p "$2" --extra-arg=-std=gnu++17 blackhole/*.cpp 2>/dev/null ;;
licence) # pictures cannot carry a line; the licence is its own
	bad=$(find . \( -name build -o -name .git -o -name __pycache__ \) -prune -o -type f ! -name LICENSE ! -name '*.jpg' ! -name '*.png' ! -name '*.json' ! -name '.gitignore' -print |
		xargs grep -L 'SPDX-License-Identifier: AGPL-3.0-or-later' || true)
	[ -z "$bad" ] || die "no SPDX line in" $bad ;;
layers) # physics knows nothing of POV-Ray; what we add to POV-Ray nothing of the farm
	! grep -rnE '#include *[<"](backend|base|frontend|vfe|pov)' blackhole || die "blackhole/ includes POV-Ray"
	! grep -rnE '#include *[<"]distribute' source blackhole || die "the ray tracer includes the farm"
	! grep -rnE '#include *[<"](blackhole/|backend|base|frontend|vfe|pov)' distribute || die "the farm includes the ray tracer" ;;
*) die "what is '$1'?" ;;
esac
