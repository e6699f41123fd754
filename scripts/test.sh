#!/usr/bin/env bash
# Installs what is missing, builds, runs every test. Arguments go to ctest: scripts/test.sh -L unit
set -euo pipefail
cd "$(dirname "$0")/.."
preset="${PRESET:-release}"

scripts/setup.sh --tests
cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset"
REQUIRE_GL=1 ctest --test-dir "build/$preset" --output-on-failure --no-tests=error "$@"
