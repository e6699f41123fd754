// One level of the map's pyramid, coarse to fine: its own fixed-point deposits plus what lies above (ABOVE 1), spread
// bilinearly. The finest (FINEST 1) becomes concentration (1 = as bright as direct light), linear BT.709 with the light's
// own colour divided out, and books what was deposited. Spreading is a partition of unity: no light is lost or made.
// The inner map (JUDGED 1) also books what tells its error: how much the halves of the photons differ at the finest level,
// how rough each coarser one is, which is what its width has blurred, and how rough the finest along its rows.
// A thread resolves two rows of kScanTexels texels: their coarser texels pass by once, in columns of three.
#include "shared/layout.h"
#include "common/view.glsl"

layout(local_size_x = kGroupSize) in;
layout(std430, binding = kBindLedger) buffer Ledger { uint ledger[]; };
layout(rgba32f, binding = 0) uniform writeonly image2D u_out;

#if ADAPTED
uniform sampler2D u_kept;            // XYZ, even - odd Y of this level, from map_adapt
#else
uniform usamplerBuffer u_map;        // kMapWords of each texel: one fetch where a storage buffer takes four loads
#endif
uniform int u_firstTexel;            // of this level in the buffer
uniform float u_luminance;           // ledger units per fixed-point unit of Y
#if ABOVE
uniform sampler2D u_above;           // XYZ, even - odd Y in fixed-point units per texel of the next coarser level
#endif
#if FINEST
uniform View u_view;
uniform sampler2D u_receivers;      // layer values of the view; they go into alpha
uniform mat3 u_xyzToRgb;
uniform float u_fluxPerFixed;
#endif
const float kRoughnessUnit = 1.0 / 16.0;   // all levels' in one bank still fit 32 bits

float g_deposited = 0.0, g_halves = 0.0, g_grain = 0.0;

void book(int row, float amount) {
    uint bank = (gl_WorkGroupID.x % uint(kLedgerBanks)) * uint(kLedgerRows);
    if (amount > 0.0) atomicAdd(ledger[bank + uint(row)], uint(amount * u_luminance + 0.5));
}

#if ABOVE
// A column of coarser texels: what it gives to the lower and to the upper of the two rows, before it is spread along them.
struct Column {
    vec4 lower, upper;
    float own, ends;   // Y of its middle texel, and of the two others together
};

Column columnAt(int x, int y) {
    ivec2 most = textureSize(u_above, 0) - 1;
    x = clamp(x, 0, most.x);
    vec4 below = texelFetch(u_above, ivec2(x, max(y - 1, 0)), 0), middle = texelFetch(u_above, ivec2(x, y), 0);
    vec4 above = texelFetch(u_above, ivec2(x, min(y + 1, most.y)), 0);
    return Column(0.1875 * middle + 0.0625 * below, 0.1875 * middle + 0.0625 * above, middle.y, below.y + above.y);
}
#endif

// Writes a texel that gets `above` from the coarser levels; `passed`: Y of the two texels before it in the row.
void resolve(ivec2 texel, vec4 above, bool third, inout vec2 passed) {
    ivec2 size = imageSize(u_out);
#if ADAPTED
    vec4 sum = texelFetch(u_kept, texel, 0) + above;
#else
    uvec4 words = texelFetch(u_map, u_firstTexel + texel.x + texel.y * size.x);
    vec4 sum = vec4(words.x, words.y + words.z, words.w, int(words.y - words.z)) + above;
#endif
#if FINEST
    g_deposited += sum.y;
    g_halves += abs(sum.w);
    if (third) g_grain += abs(passed.y - 0.5 * (passed.x + sum.y));
    passed = vec2(passed.y, sum.y);
    vec2 uv = (vec2(texel) + 0.5) / vec2(size);
    vec3 rgb = u_xyzToRgb * sum.xyz * (u_fluxPerFixed / texelExtent(u_view, uv, 1.0 / vec2(size)));
    imageStore(u_out, texel, vec4(rgb, texelFetch(u_receivers, texel, 0).x));
#else
    imageStore(u_out, texel, sum);
#endif
}

void main() {
    ivec2 size = imageSize(u_out);
    int runs = (size.x + kScanTexels - 1) / kScanTexels;
    int first = int(gl_GlobalInvocationID.x) % runs * kScanTexels, row = int(gl_GlobalInvocationID.x) / runs;
    if (2 * row >= size.y) return;
    vec2 passedLower = vec2(0.0), passedUpper = vec2(0.0);
    float rough = 0.0;
#if ABOVE
    Column left = columnAt(first / 2 - 1, row), middle = columnAt(first / 2, row);
#endif
    for (int x = first; x < min(first + kScanTexels, size.x); x += 2) {
        bool third = x > first;
        vec4 lower[2], upper[2];
#if ABOVE
        Column right = columnAt(x / 2 + 1, row);
        lower[0] = 0.75 * middle.lower + 0.25 * left.lower;
        lower[1] = 0.75 * middle.lower + 0.25 * right.lower;
        upper[0] = 0.75 * middle.upper + 0.25 * left.upper;
        upper[1] = 0.75 * middle.upper + 0.25 * right.upper;
        rough += abs(middle.own - 0.25 * (left.ends + right.ends));
        left = middle;
        middle = right;
#else
        lower[0] = lower[1] = upper[0] = upper[1] = vec4(0.0);
#endif
        resolve(ivec2(x, 2 * row), lower[0], third, passedLower);
        resolve(ivec2(x + 1, 2 * row), lower[1], third, passedLower);
        resolve(ivec2(x, 2 * row + 1), upper[0], third, passedUpper);
        resolve(ivec2(x + 1, 2 * row + 1), upper[1], third, passedUpper);
    }
#if FINEST
    book(kLedgerDeposited, g_deposited);
#if JUDGED
    book(kLedgerHalves, g_halves);
    book(kLedgerGrain, g_grain * kRoughnessUnit);
#else
    book(kLedgerOuter, g_deposited);
#endif
#endif
#if JUDGED
    book(kLedgerRoughness, rough * kRoughnessUnit);
#endif
}
