// One level of the map's pyramid, coarse to fine: its own fixed-point deposits plus what lies above, spread bilinearly.
// The finest (FINEST 1) becomes concentration (1 = as bright as direct light), linear BT.709 with the light's own colour
// divided out, and books what was deposited. Spreading is a partition of unity: no light is lost or made.
#include "shared/layout.h"
#include "common/view.glsl"

layout(local_size_x = kGroupSize) in;
layout(std430, binding = kBindLedger) buffer Ledger { uint ledger[]; };
layout(rgba32f, binding = 0) uniform writeonly image2D u_out;

uniform usamplerBuffer u_map;        // kMapWords of each texel: one fetch where a storage buffer takes four loads
uniform sampler2D u_above;           // XYZ in fixed-point units per texel of the next coarser level
uniform bool u_hasAbove;
uniform int u_firstTexel;            // of this level in the buffer
#if FINEST
uniform View u_view;
uniform sampler2D u_receivers;      // layer values of the view; they go into alpha
uniform mat3 u_xyzToRgb;
uniform float u_fluxPerFixed;
uniform float u_luminance;           // ledger units per fixed-point unit of Y
#endif

void main() {
    ivec2 size = imageSize(u_out);
    int first = int(gl_GlobalInvocationID.x) * kScanTexels;
    float deposited = 0.0;
    for (int i = first; i < min(first + kScanTexels, size.x * size.y); ++i) {
        ivec2 texel = ivec2(i % size.x, i / size.x);
        vec2 uv = (vec2(texel) + 0.5) / vec2(size);
        uvec4 words = texelFetch(u_map, u_firstTexel + i);
        vec3 xyz = vec3(words.x, words.y + words.z, words.w);
        if (u_hasAbove) xyz += 0.25 * textureLod(u_above, uv, 0.0).xyz;
#if FINEST
        deposited += xyz.y;
        vec3 rgb = u_xyzToRgb * xyz * (u_fluxPerFixed / texelExtent(u_view, uv, 1.0 / vec2(size)));
        imageStore(u_out, texel, vec4(rgb, texelFetch(u_receivers, texel, 0).x));
#else
        imageStore(u_out, texel, vec4(xyz, 1.0));
#endif
    }
#if FINEST
    if (deposited == 0.0) return;
    uint bank = (gl_WorkGroupID.x % uint(kLedgerBanks)) * uint(kLedgerRows);
    atomicAdd(ledger[bank + uint(kLedgerDeposited)], uint(deposited * u_luminance + 0.5));
#endif
}
