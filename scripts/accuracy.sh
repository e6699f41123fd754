#!/usr/bin/env bash
# Measures everything that docs/accuracy.md says and writes it there: tables between its markers, plots beside it.
set -euo pipefail
cd "$(dirname "$0")/.."
preset="${PRESET:-release}"
out="build/accuracy"
doc="docs/accuracy.md"

help() {
    cat <<'TEXT'
scripts/accuracy.sh [--quick] [--fresh] [PART...]
    Builds caustream-bench, measures, and rewrites the blocks of docs/accuracy.md (<!-- begin:PART --> ... <!-- end:PART -->)
    and the plots in docs/images/accuracy. About a quarter of an hour on two quiet cores; the references that it traces are
    kept for the next time. What was cut short goes on where it ended.

    PART: error-vs-time, vs-thesis, estimate, converge, peers, stability, omissions; all of them unless some are named.
    converge traces a reference of each built-in scene (half an hour at first); peers needs POV-Ray (apt-get install povray)
    and is left out where it is missing, unless it is named.
    --quick  fewer configurations, photons and cases, to try; writes to build/accuracy only
    --fresh  measures again what build/accuracy holds already
TEXT
}

quick=()
fresh=()
parts=()
while [[ $# -gt 0 ]]; do
    case "$1" in
        -h | --help)
            help
            exit 0
            ;;
        --quick) quick=(--quick) ;;
        --fresh) fresh=(--fresh) ;;
        error-vs-time | vs-thesis | estimate | converge | peers | stability | omissions) parts+=("$1") ;;
        *)
            echo "accuracy: no such part or option: $1 (--help lists them)" >&2
            exit 1
            ;;
    esac
    shift
done
if [[ ${#parts[@]} -eq 0 ]]; then
    parts=(error-vs-time vs-thesis estimate converge stability omissions)
    command -v povray >/dev/null && parts+=(peers)
fi
[[ ${#quick[@]} -eq 0 ]] || out="build/accuracy-quick"

scripts/setup.sh
cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset" --target caustream-bench >&2
bench="build/$preset/bin/caustream-bench"
mkdir -p "$out" docs/images/accuracy

# replace PART: the block's lines in the document become those of $out/PART.md.
replace() {
    grep -q "<!-- begin:$1 -->" "$doc" && grep -q "<!-- end:$1 -->" "$doc" || {
        echo "accuracy: $doc has no block \"$1\"" >&2
        exit 1
    }
    awk -v part="$1" -v file="$out/$1.md" '
        $0 == "<!-- begin:" part " -->" { print; while ((getline line < file) > 0) print line; inside = 1 }
        $0 == "<!-- end:" part " -->" { inside = 0 }
        !inside { print }' "$doc" >"$out/accuracy.md"
    cp "$out/accuracy.md" "$doc"
}

for part in "${parts[@]}"; do
    echo "== $part" >&2
    case "$part" in
        error-vs-time) "$bench" error-vs-time --out "$out" "${quick[@]}" "${fresh[@]}" ;;
        vs-thesis) "$bench" error-vs-time --vs-thesis --out "$out/vs-thesis" "${quick[@]}" "${fresh[@]}" && cp "$out/vs-thesis/vs-thesis.md" "$out" ;;
        estimate) { echo '```text'; "$bench" estimate | tee /dev/stderr; echo '```'; } >"$out/estimate.md" ;;
        converge) "$bench" converge --all --references --markdown "$out/converge.md" "${quick[@]}" ;;
        peers)
            "$bench" peers --markdown "$out/peers-one.md" && "$bench" peers --all-wavelengths --counts 400000 1600000 --markdown "$out/peers-all.md" &&
                { cat "$out/peers-one.md" && echo && cat "$out/peers-all.md"; } >"$out/peers.md"
            ;;
        *) "$bench" "$part" --markdown "$out/$part.md" ;;
    esac
    [[ ${#quick[@]} -eq 0 ]] || continue
    replace "$part"
    [[ "$part" != error-vs-time ]] || cp "$out"/*.svg docs/images/accuracy/
done
