#!/usr/bin/env bash
# Who may include whom (CONTRIBUTING.md). Prints every include that points back up, and fails if there is one.
set -euo pipefail
cd "${1:-$(dirname "$0")/../..}"

# folder | what its own includes may begin with. The longest folder that holds a file decides; a name without a folder
# is one of server/ itself. "embedded" is made by cmake/Embed.cmake.
rules='
protocol          | protocol/
server            | error.h log.h config.h counters.h metrics_text.h notify.h plan_report.h supervise.h service.h test_frames.h scheduler.h viewer.h render_thread.h resolve_request.h embedded/ optics/ scene/ gl/ render/ stream/ session/ net/ protocol/
server/optics     | optics/
server/scene      | scene/ optics/ embedded/
server/gl         | gl/ error.h embedded/
server/render     | render/ scene/ optics/ gl/ shaders/shared/ error.h
server/stream     | stream/ render/frame.h protocol/ error.h
server/session    | session/ scene/ stream/ protocol/ error.h
server/net        | net/ session/ protocol/ embedded/ error.h log.h
client            | client/connection/ protocol/
client/shot       | client/shot/ client/connection/ protocol/
client/view       | client/view/ client/connection/ protocol/
scenes            | scenes/
shaders           | shared/ common/ passes/
shaders/common    | common/ shared/
shaders/shared    |
'

found="$(find protocol server client scenes shaders -type f \
    \( -name '*.h' -o -name '*.cpp' -o -name '*.glsl' -o -name '*.vert' -o -name '*.geom' -o -name '*.frag' -o -name '*.comp' \) -print0 |
    xargs -0 grep -nE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' | LC_ALL=C sort)"
[[ -n "$found" ]] || {
    echo "includes: no include found below $PWD; is this the repository?" >&2
    exit 1
}

awk -v rules="$rules" '
BEGIN {
    count = split(rules, lines, "\n")
    for (i = 1; i <= count; ++i) {
        if (split(lines[i], halves, "|") < 2) continue
        gsub(/ /, "", halves[1])
        allowed[halves[1]] = halves[2]
    }
}
{
    file = $0; sub(/:.*/, "", file)
    target = $0; sub(/^[^"]*"/, "", target); sub(/".*/, "", target)
    folder = file
    do { sub(/\/[^\/]*$/, "", folder) } while (!(folder in allowed) && index(folder, "/"))
    ok = 0
    starts = split(allowed[folder], start, " ")
    for (i = 1; i <= starts; ++i) ok = ok || index(target, start[i]) == 1
    if (!ok) {
        print $0 "\n    " folder "/ may include: " (starts ? allowed[folder] : "nothing of ours")
        ++wrong
    }
}
END {
    if (wrong) print wrong " of " NR " includes point where they may not"
    exit wrong > 0
}' <<<"$found"
