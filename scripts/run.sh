#!/usr/bin/env bash
# Installs what is missing, builds, runs: a server with its page and window, or one picture.
set -euo pipefail
root="$(cd "$(dirname "$0")/.." && pwd)"
preset="${PRESET:-release}"
bin="$root/build/$preset/bin"

help() {
    cat <<'TEXT'
scripts/run.sh [server options]
    Installs what is missing, builds, starts caustream-server on the embedded scenes and prints the page's address. Opens
    caustream-view where there is a display. Ctrl-C stops both. Options go to the server: --port 0, --gpu list, ...

scripts/run.sh --shot FILE [--scene NAME|FILE.glb] [more options of caustream-shot]
    Fetches one frame through the socket into FILE (.png, .npy, .exr or .jpg) and ends.
        scripts/run.sh --shot gem.png --scene gem
        scripts/run.sh --shot map.npy --scene prism --target spectral --set transport.wavelengths=21
    build/release/bin/caustream-shot --help lists the options.

scripts/run.sh --batch FILE --out DIR [more options of caustream-shot]
scripts/run.sh --replay LOG --out DIR [more options of caustream-shot]
    Draws the lines of FILE, or plays LOG, with a server of its own (docs/batch.md), and ends.

PRESET=debug scripts/run.sh uses another preset of CMakePresets.json than release.
TEXT
}

shoots=""
arguments=()
while [[ $# -gt 0 ]]; do
    case "$1" in
        -h | --help)
            help
            exit 0
            ;;
        --shot)
            [[ $# -ge 2 ]] || {
                echo "run: --shot needs a file, for example: scripts/run.sh --shot gem.png --scene gem" >&2
                exit 1
            }
            shoots=yes
            arguments+=(--out "$2")
            shift
            ;;
        --batch | --batch=* | --replay | --replay=*)
            shoots=yes
            arguments+=("$1")
            ;;
        *) arguments+=("$1") ;;
    esac
    shift
done

targets=(caustream-server caustream-shot)
[[ -n "$shoots" ]] || targets+=(caustream-view)
"$root/scripts/setup.sh"
(
    cd "$root"
    cmake --preset "$preset" >/dev/null
    cmake --build --preset "$preset" --target "${targets[@]}" >&2
)

server=""
view=""
stop() {
    trap - EXIT INT TERM
    [[ -z "$view" ]] || kill "$view" 2>/dev/null || true
    [[ -z "$server" ]] || kill "$server" 2>/dev/null || true
    wait
}
trap stop EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# The server says on standard output where it is, once frames can be asked for.
if [[ -n "$shoots" ]]; then
    options=(--port 0 --log-level error)
else
    options=("${arguments[@]}")
fi
coproc SERVER { exec "$bin/caustream-server" "${options[@]}"; }
server="$SERVER_PID"
exec {said}<&"${SERVER[0]}"
address=""
while read -r line <&"$said"; do
    if [[ "$line" == "ready "* ]]; then
        address="${line#ready }"
        break
    fi
    echo "$line"
done
if [[ -z "$address" ]]; then
    # It ended by itself: told something (--gpu list), or said on standard error why it cannot run.
    pid="$server"
    server=""
    wait "$pid"
    exit
fi

if [[ -n "$shoots" ]]; then
    "$bin/caustream-shot" --url "$address" "${arguments[@]}"
    exit
fi

echo "caustream is at $address (open it in a browser; Ctrl-C stops)"
if [[ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]]; then
    "$bin/caustream-view" --url "$address" &
    view="$!"
fi
wait "$server"
