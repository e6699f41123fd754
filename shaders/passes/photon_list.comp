// Compacts the texels of the front layer that hold the caster and that the light reaches. Each thread scans a run of
// texels and takes its places in the list with one atomic.
#include "shared/layout.h"
#include "common/view.glsl"
#include "common/emission.glsl"

layout(local_size_x = kGroupSize) in;
layout(std430, binding = kBindList) buffer List {
    uint groups[3];              // of photon_trace's indirect dispatch
    uint count;
    uint texels[];               // x + y * width
};
layout(std430, binding = kBindLedger) buffer Ledger { uint ledger[]; };

uniform sampler2D u_front;
uniform View u_emission;

void main() {
    ivec2 size = textureSize(u_front, 0);
    int first = int(gl_GlobalInvocationID.x) * kScanTexels;
    uint lit = 0u;
    for (int i = 0; i < kScanTexels; ++i) {
        int index = first + i;
        if (index >= size.x * size.y) break;
        ivec2 texel = ivec2(index % size.x, index / size.x);
        if (texelFetch(u_front, texel, 0).w <= 0.0) continue;
        vec2 uv = (vec2(texel) + 0.5) / vec2(size);
        if (emittedShare(viewDirection(u_emission, uv)) > 0.0) lit |= 1u << i;
    }
    uint found = uint(bitCount(lit));
    if (found == 0u) return;
    uint place = atomicAdd(count, found);
    atomicAdd(ledger[(gl_WorkGroupID.x % uint(kLedgerBanks)) * uint(kLedgerRows) + uint(kLedgerPhotons)], found);
    atomicMax(groups[0], (place + found + uint(kGroupSize) - 1u) / uint(kGroupSize));
    for (int i = 0; i < kScanTexels; ++i) {
        if ((lit & (1u << i)) != 0u) texels[place++] = uint(first + i);
    }
}
