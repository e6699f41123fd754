// One step up the pyramid of an exactly traced map: of four texels, what enough photons landed in stays where it is, the
// rest goes to the texel above, to be spread over it by map_resolve. How much stays is the same for all four and depends on
// how many photons landed, not on how bright they were: no light is lost or made, and with more photons less is spread.
#include "shared/layout.h"
layout(local_size_x = kGroupSize) in;
layout(rgba32f, binding = 0) uniform writeonly image2D u_kept;      // XYZ, even - odd Y, map units; this level
layout(rgba32f, binding = 1) uniform writeonly image2D u_rest;      // the level above
layout(rg32f, binding = 2) uniform writeonly image2D u_total;       // landings below and their even - odd Y, the level above
layout(std430, binding = kBindLedger) buffer Ledger { uint ledger[]; };

#if FINEST
uniform usamplerBuffer u_sums;      // two texels of four words for each of the map's
uniform usamplerBuffer u_landings;
#else
uniform sampler2D u_restBelow, u_totalBelow;
#endif
uniform float u_cells;              // ledger units per map unit, where the level above is that of 4 x 4 texels; else 0
uniform float u_enough;             // landings that four texels need to keep their light; 0: none

float wide(uvec2 words) { return float(words.y) * 4294967296.0 + float(words.x); }

vec4 sumAt(ivec2 texel, int width) {
#if FINEST
    int at = 2 * (texel.x + texel.y * width);
    uvec4 a = texelFetch(u_sums, at), b = texelFetch(u_sums, at + 1);
    // The difference first in whole numbers: it is small beside the sums
    uint low = a.z - b.x;
    int high = int(a.w - b.y) - int(a.z < b.x);
    return vec4(wide(a.xy), wide(a.zw) + wide(b.xy), wide(b.zw), float(high) * 4294967296.0 + float(low));
#else
    return texelFetch(u_restBelow, texel, 0);
#endif
}

vec2 totalAt(ivec2 texel, int width, vec4 sum) {
#if FINEST
    return vec2(texelFetch(u_landings, texel.x + texel.y * width).x, sum.w);
#else
    return texelFetch(u_totalBelow, texel, 0).xy;
#endif
}

void main() {
    ivec2 above = imageSize(u_rest);
    int i = int(gl_GlobalInvocationID.x);
    if (i >= above.x * above.y) return;
    ivec2 parent = ivec2(i % above.x, i / above.x);
    vec4 sums[4];
    vec2 total = vec2(0.0);
    for (int j = 0; j < 4; ++j) {
        ivec2 texel = 2 * parent + ivec2(j & 1, j >> 1);
        sums[j] = sumAt(texel, 2 * above.x);
        total += totalAt(texel, 2 * above.x, sums[j]);
    }
    float stays = u_enough > 0.0 ? smoothstep(0.25, 1.0, total.x / u_enough) : 1.0;
    vec4 rest = vec4(0.0);
    for (int j = 0; j < 4; ++j) {
        imageStore(u_kept, 2 * parent + ivec2(j & 1, j >> 1), stays * sums[j]);
        rest += (1.0 - stays) * sums[j];
    }
    imageStore(u_rest, parent, rest);
    imageStore(u_total, parent, vec4(total, 0.0, 0.0));
    uint bank = (gl_WorkGroupID.x % uint(kLedgerBanks)) * uint(kLedgerRows);
    if (u_cells > 0.0) atomicAdd(ledger[bank + uint(kLedgerCells)], uint(abs(total.y) * u_cells + 0.5));
}
