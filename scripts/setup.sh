#!/usr/bin/env bash
# Installs what the build, the programs and the tests need from Debian 12, once. Nothing when all of it is there.
set -euo pipefail

packages=(
    build-essential cmake ninja-build ccache pkg-config
    libegl-dev libepoxy-dev libgl-dev libgl1-mesa-dri libglm-dev libglfw3-dev libimgui-dev
    libwebsockets-dev libturbojpeg0-dev libpng-dev libtinygltf-dev nlohmann-json3-dev libcli11-dev
    libexpected-dev libembree-dev libopenexr-dev libgtest-dev libgmock-dev libssl-dev zlib1g-dev libzstd-dev prometheus-cpp-dev
    glmark2-data
)
# What only the tests need: a display without a screen, mouse events, a browser, a client in another language, a compiler with
# libFuzzer and its symbols, certificates, a load balancer, systemd to check its unit with.
test_packages=(xvfb xdotool chromium ca-certificates python3 python3-websockets clang libclang-rt-14-dev llvm openssl haproxy systemd)
promtool="$(dirname "$0")/../build/tools/promtool"   # out of a package whose other half is a daemon

missing() {
    local package
    for package in "$@"; do
        dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || echo "$package"
    done
}

wanted=("${packages[@]}")
if [[ "${1:-}" == --tests ]]; then
    wanted+=("${test_packages[@]}")
    command -v node >/dev/null || wanted+=(nodejs npm)
    command -v npm >/dev/null || wanted+=(npm)
fi
mapfile -t absent < <(missing "${wanted[@]}" | sort -u)
tools=()
if [[ "${1:-}" == --tests ]] && ! command -v promtool >/dev/null && [[ ! -x "$promtool" ]]; then
    tools=(promtool)
fi
[[ ${#absent[@]} -eq 0 && ${#tools[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $EUID -ne 0 ]]; then
    command -v sudo >/dev/null || {
        echo "setup: missing packages: ${absent[*]}; install them as root, or install sudo" >&2
        exit 1
    }
    as_root=(sudo)
fi
wanted=("${absent[@]}" "${tools[@]}")
echo "setup: installing ${wanted[*]}" >&2
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq

if [[ ${#absent[@]} -gt 0 ]]; then
    # No daemon of a package is to start because a test wants its program (invoke-rc.d(8)).
    policy=/usr/sbin/policy-rc.d
    if [[ ! -e "$policy" ]]; then
        trap '"${as_root[@]}" rm -f "$policy"' EXIT
        printf '#!/bin/sh\nexit 101\n' | "${as_root[@]}" tee "$policy" >/dev/null
        "${as_root[@]}" chmod 755 "$policy"
    fi
    "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${absent[@]}" >&2
fi

if [[ ${#tools[@]} -gt 0 ]]; then
    folder="$(mktemp -d)"
    (cd "$folder" && apt-get download -qq prometheus >&2)
    mkdir -p "$(dirname "$promtool")"
    dpkg-deb --fsys-tarfile "$folder"/prometheus_*.deb | tar -xO ./usr/bin/promtool >"$promtool.new"
    chmod 755 "$promtool.new"
    mv "$promtool.new" "$promtool"
    rm -r "$folder"
fi
