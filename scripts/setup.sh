#!/usr/bin/env bash
# Installs what the build, the programs and the tests need from Debian 12, once. Nothing when all of it is there.
set -euo pipefail

packages=(
    build-essential cmake ninja-build ccache pkg-config
    libegl-dev libepoxy-dev libgl-dev libgl1-mesa-dri libglm-dev libglfw3-dev libimgui-dev
    libwebsockets-dev libturbojpeg0-dev libpng-dev libtinygltf-dev nlohmann-json3-dev libcli11-dev
    libexpected-dev libembree-dev libgtest-dev libgmock-dev libssl-dev zlib1g-dev libzstd-dev
    glmark2-data
)
# What only the tests need: a display without a screen, mouse events, a browser, a client in another language, a compiler with
# libFuzzer and its symbols.
test_packages=(xvfb xdotool chromium ca-certificates python3 python3-websockets clang libclang-rt-14-dev llvm)

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
[[ ${#absent[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $EUID -ne 0 ]]; then
    command -v sudo >/dev/null || {
        echo "setup: missing packages: ${absent[*]}; install them as root, or install sudo" >&2
        exit 1
    }
    as_root=(sudo)
fi
echo "setup: installing ${absent[*]}" >&2
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${absent[@]}" >&2
