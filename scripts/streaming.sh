#!/usr/bin/env bash
# Plays every scenario of caustream-bench stream and writes what it measured into docs/streaming.md.
set -euo pipefail
cd "$(dirname "$0")/.."
preset="${PRESET:-release}"
out="build/streaming"
doc="docs/streaming.md"

help() {
    cat <<'TEXT'
scripts/streaming.sh [--quick] [SCENARIO...]
    Builds caustream-bench and caustream-server, plays the scenarios, and rewrites the block of docs/streaming.md
    (<!-- begin:streaming --> ... <!-- end:streaming -->) and docs/images/streaming/ladder.svg. About three quarters of an
    hour on a quiet machine: thirty minutes of it are soak, five steady. What is named is measured anew, the other rows stay.

    SCENARIO: steady, ladder, neighbours, latency, shared, soak, malformed; all of them unless some are named.
    --quick  short forms, to try; writes to build/streaming-quick only
TEXT
}

quick=0
scenarios=()
while [[ $# -gt 0 ]]; do
    case "$1" in
        -h | --help)
            help
            exit 0
            ;;
        --quick) quick=1 ;;
        steady | ladder | neighbours | latency | shared | soak | malformed) scenarios+=("$1") ;;
        *)
            echo "streaming: no such scenario or option: $1 (--help lists them)" >&2
            exit 1
            ;;
    esac
    shift
done
all=(steady ladder neighbours latency shared malformed soak)
[[ ${#scenarios[@]} -gt 0 ]] || scenarios=("${all[@]}")
[[ $quick -eq 0 ]] || out="build/streaming-quick"

scripts/setup.sh
cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset" --target caustream-bench caustream-server >&2
bench="build/$preset/bin/caustream-bench"
mkdir -p "$out" docs/images/streaming

missed=0
for scenario in "${scenarios[@]}"; do
    echo "== $scenario" >&2
    options=()
    if [[ $quick -eq 0 ]]; then
        case "$scenario" in
            steady) options=(--minutes 5) ;;
            neighbours) options=(--minutes 1) ;;
            soak) options=(--minutes 30) ;;
        esac
    else
        case "$scenario" in
            steady | neighbours) options=(--minutes 0.1) ;;
            soak) options=(--minutes 0.5) ;;
            malformed) options=(--count 1000) ;;
        esac
    fi
    [[ "$scenario" != ladder ]] || options+=(--svg "$out/ladder.svg")
    [[ "$scenario" != malformed || ! -d tests/fuzz/corpus ]] || options+=(--corpus tests/fuzz/corpus)
    rm -f "$out/$scenario.json"
    "$bench" stream "$scenario" "${options[@]}" --json "$out/$scenario.json" --markdown "$out/$scenario.md" || missed=1
done

# One table of what was measured now or before, in the order above
{
    echo "| scenario | figure | measured | limit | held |"
    echo "| --- | --- | --- | --- | --- |"
    for scenario in "${all[@]}"; do
        [[ ! -f "$out/$scenario.md" ]] || tail -n +3 "$out/$scenario.md"
    done
} >"$out/table.md"
if [[ $quick -eq 0 ]]; then
    awk -v file="$out/table.md" '
        $0 == "<!-- begin:streaming -->" { print; while ((getline line < file) > 0) print line; inside = 1 }
        $0 == "<!-- end:streaming -->" { inside = 0 }
        !inside { print }' "$doc" >"$out/streaming.md"
    cp "$out/streaming.md" "$doc"
    [[ ! -f "$out/ladder.svg" ]] || cp "$out/ladder.svg" docs/images/streaming/
fi
exit $missed
