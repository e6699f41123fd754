// What too few wavelengths cost the map: each stands for a stretch of the spectrum whose light would land along u_step.
// Books what the map's luminance differs from its mean over that stretch by, at one texel of each block of 4 x 4, and the
// luminance of those texels.
#include "shared/layout.h"

layout(local_size_x = kGroupSize) in;
layout(std430, binding = kBindLedger) buffer Ledger { uint ledger[]; };

uniform sampler2D u_map;             // concentration, linear BT.709
uniform vec2 u_step;                 // texels along x and y that a stretch spans
uniform float u_ledgerPerTexel;      // ledger units per texel of concentration 1

const int kBlock = 4;
#ifndef kTaps
#define kTaps 2                        // of a line: fixed, as a loop of any length costs two and a half times as much
#endif
const vec3 kLuminance = vec3(0.2126, 0.7152, 0.0722);

float luminanceAt(vec2 texel) {
    return max(dot(textureLod(u_map, texel / vec2(textureSize(u_map, 0)), 0.0).rgb, kLuminance), 0.0);
}

// Mean over `span` texels of a line around the texel's middle.
float meanAlong(vec2 middle, vec2 axis, float span) {
    float sum = 0.0;
    for (int i = 0; i < kTaps; ++i) sum += luminanceAt(middle + axis * (span * ((float(i) + 0.5) / float(kTaps) - 0.5)));
    return sum / float(kTaps);
}

void book(int row, float amount) {
    uint bank = (gl_WorkGroupID.x % uint(kLedgerBanks)) * uint(kLedgerRows);
    if (amount > 0.0) atomicAdd(ledger[bank + uint(row)], uint(amount * u_ledgerPerTexel + 0.5));
}

void main() {
    ivec2 blocks = textureSize(u_map, 0) / kBlock;
    int index = int(gl_GlobalInvocationID.x);
    if (index >= blocks.x * blocks.y) return;
    // Not the same texel of every block, or a pattern of the map's could hide
    uint turn = uint(index) * 2654435761u >> 24;
    vec2 texel = vec2(index % blocks.x, index / blocks.x) * float(kBlock) + vec2(turn & 3u, (turn >> 2) & 3u) + 0.5;
    float own = luminanceAt(texel);
    vec2 differs = vec2(own - meanAlong(texel, vec2(1.0, 0.0), u_step.x), own - meanAlong(texel, vec2(0.0, 1.0), u_step.y));
    book(kLedgerStep, length(differs));
    book(kLedgerStepOf, own);
}
