// One level of the map's pyramid, coarse to fine: its own fixed-point deposits plus what lies above, spread bilinearly.
// The finest (FINEST 1) becomes concentration (1 = as bright as direct light), linear BT.709 with the light's own colour
// divided out, and books what was deposited. Spreading is a partition of unity: no light is lost or made.
// The inner map (JUDGED 1) also books what tells its error: how much the halves of the photons differ at the finest level,
// how rough each coarser one is, which is what its width
// has blurred, and how rough the finest along its rows.
#include "shared/layout.h"
#include "common/view.glsl"

layout(local_size_x = kGroupSize) in;
layout(std430, binding = kBindLedger) buffer Ledger { uint ledger[]; };
layout(rgba32f, binding = 0) uniform writeonly image2D u_out;

uniform usamplerBuffer u_map;        // kMapWords of each texel: one fetch where a storage buffer takes four loads
uniform sampler2D u_above;           // XYZ, even - odd Y in fixed-point units per texel of the next coarser level
uniform bool u_hasAbove;
uniform int u_firstTexel;            // of this level in the buffer
uniform float u_luminance;           // ledger units per fixed-point unit of Y
#if FINEST
uniform View u_view;
uniform sampler2D u_receivers;      // layer values of the view; they go into alpha
uniform mat3 u_xyzToRgb;
uniform float u_fluxPerFixed;
#endif
const float kRoughnessUnit = 1.0 / 16.0;   // all levels' in one bank still fit 32 bits

void book(int row, float amount) {
    uint bank = (gl_WorkGroupID.x % uint(kLedgerBanks)) * uint(kLedgerRows);
    if (amount > 0.0) atomicAdd(ledger[bank + uint(row)], uint(amount * u_luminance + 0.5));
}

// What a texel of the coarser level differs from the mean of its diagonal neighbours by, in Y.
float roughness(ivec2 texel) {
    ivec2 most = textureSize(u_above, 0) - 1, low = max(texel - 1, ivec2(0)), high = min(texel + 1, most);
    float around = texelFetch(u_above, low, 0).y + texelFetch(u_above, high, 0).y +
                   texelFetch(u_above, ivec2(low.x, high.y), 0).y + texelFetch(u_above, ivec2(high.x, low.y), 0).y;
    return abs(texelFetch(u_above, texel, 0).y - 0.25 * around);
}

void main() {
    ivec2 size = imageSize(u_out);
    int first = int(gl_GlobalInvocationID.x) * kScanTexels;
    float deposited = 0.0, halves = 0.0, rough = 0.0, grain = 0.0;
    vec2 passed = vec2(0.0);         // Y of the two texels before in the row
    for (int i = first; i < min(first + kScanTexels, size.x * size.y); ++i) {
        ivec2 texel = ivec2(i % size.x, i / size.x);
        vec2 uv = (vec2(texel) + 0.5) / vec2(size);
        uvec4 words = texelFetch(u_map, u_firstTexel + i);
        vec4 sum = vec4(words.x, words.y + words.z, words.w, int(words.y - words.z));
        if (u_hasAbove) sum += 0.25 * textureLod(u_above, uv, 0.0);
#if JUDGED
        if (u_hasAbove && ((texel.x | texel.y) & 1) == 0) rough += roughness(texel >> 1);
#endif
#if FINEST
        deposited += sum.y;
        halves += abs(sum.w);
        if (i >= first + 2 && texel.x >= 2) grain += abs(passed.y - 0.5 * (passed.x + sum.y));
        passed = vec2(passed.y, sum.y);
        vec3 rgb = u_xyzToRgb * sum.xyz * (u_fluxPerFixed / texelExtent(u_view, uv, 1.0 / vec2(size)));
        imageStore(u_out, texel, vec4(rgb, texelFetch(u_receivers, texel, 0).x));
#else
        imageStore(u_out, texel, sum);
#endif
    }
#if FINEST
    book(kLedgerDeposited, deposited);
#if JUDGED
    book(kLedgerHalves, halves);
    book(kLedgerGrain, grain * kRoughnessUnit);
#else
    book(kLedgerOuter, deposited);
#endif
#endif
#if JUDGED
    book(kLedgerRoughness, rough * kRoughnessUnit);
#endif
}
