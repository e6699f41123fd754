#!/usr/bin/env bash
# Builds the fuzz targets with clang and runs each for a while, from tests/fuzz/corpus and what earlier runs found worth
# keeping (build/fuzz/grown). Fails with the input when one is found; it lies in build/fuzz/findings.
#
#   scripts/fuzz.sh                            every target for 60 s
#   scripts/fuzz.sh --seconds 600 glb headers  two of them for ten minutes each
#   scripts/fuzz.sh --build-only | --run-only  half of it
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=60 build=1 run=1
while [[ "${1:-}" == --* ]]; do
    case "$1" in
        --seconds) seconds="$2"; shift ;;
        --build-only) run=0 ;;
        --run-only) build=0 ;;
        *) echo "fuzz: $1 is not known; see the first lines of $0" >&2; exit 2 ;;
    esac
    shift
done
targets=("$@")
[[ ${#targets[@]} -gt 0 ]] || targets=(client_text server_text patches headers glb)

command -v clang++ >/dev/null || {
    echo "fuzz: there is no clang++; try scripts/setup.sh --tests" >&2
    exit 1
}
if ((build)); then
    cmake --preset fuzz >/dev/null
    cmake --build --preset fuzz
fi
((run)) || exit 0

# The most that an input of each may have: room for every message and a small scene, and many runs a second.
declare -A most=([client_text]=4096 [server_text]=8192 [patches]=8192 [headers]=256 [glb]=16384)
for target in "${targets[@]}"; do
    grown="build/fuzz/grown/$target" findings="build/fuzz/findings/$target"
    mkdir -p "$grown" "$findings"
    # One file a run may take no more memory than a bounded multiple of its bytes, nor longer than a person waits.
    "build/fuzz/bin/fuzz_$target" -max_total_time="$seconds" -max_len="${most[$target]}" -timeout=10 -rss_limit_mb=1024 \
        -malloc_limit_mb=64 -print_final_stats=1 -verbosity=0 -print_funcs=0 -artifact_prefix="$findings/" \
        "$grown" "tests/fuzz/corpus/$target" 2>&1 | tail -40
done
