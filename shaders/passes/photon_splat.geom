// One photon becomes kWavelengths points of the spectral map: Blanchette 2012, appendix A, the geometry shader, step by
// step and with its constants. What it leaves undone is left undone: no Fresnel, no absorption, one distance from front
// to back, the ray of total reflection goes on as if it had left, and one that heads for the light is turned round.
#ifndef kWavelengths
#define kWavelengths 7       // a variant for each number: room for more vertices costs time, used or not
#endif
#include "common/view.glsl"
#include "common/emission.glsl"
layout(points) in;
layout(points, max_vertices = kWavelengths) out;
flat in uint v_cell[];
uniform View u_lightView;
uniform sampler2D u_front, u_back;         // xyz outward normal, w layer value
uniform sampler2D u_receivers;
uniform ivec2 u_mapSize;
uniform float u_index[kWavelengths];        // of the glass over that of what is around it
uniform vec4 u_weight[kWavelengths];        // what each adds to the map; sums to 1
flat out vec4 g_splat;                     // concentration of the whole splat
flat out vec2 g_centre;                    // pixels

// The printed clear depth is the far plane.
float depthOf(float layer) { return min(layerToDepth(u_lightView, layer), u_lightView.far); }
float receiverDepth(vec3 pos) { return depthOf(textureLod(u_receivers, viewToUv(u_lightView, pos), 0.0).x); }

vec3 refraction(vec3 incident, vec3 normal, float ratio) {
    float IdotN = dot(-incident, normal);
    float cosSqr = 1.0 - ratio * ratio * (1.0 - IdotN * IdotN);
    return cosSqr <= 0.0 ? normalize(reflect(incident, normal))
                         : normalize(ratio * incident + (ratio * IdotN - sqrt(cosSqr)) * normal);
}

void main() {
    ivec2 cell = ivec2(v_cell[0] & 0xffffu, v_cell[0] >> 16), size = textureSize(u_front, 0);
    vec2 uv = (vec2(cell) + 0.5) / vec2(size);
    vec4 front = texelFetch(u_front, cell, 0);
    vec3 P_1 = layerToView(u_lightView, uv, front.w), V = viewDirection(u_lightView, uv);
    vec3 N_1 = normalize(front.xyz);
    // Printed is the difference in depth. It is the same on the axis, where the thesis's casters are; along the ray here, so
    // that a caster beside the axis is none the worse.
    float d_V = (depthOf(texelFetch(u_back, cell, 0).w) + P_1.z) / -V.z;
    // splatResolutionModifier and the spotlight's texture: the photon's flux.
    float flux = texelExtent(u_lightView, uv, 1.0 / vec2(size)) * emittedShare(V);

    for (int i = 0; i < kWavelengths; ++i) {
        vec3 T_1 = refract(V, N_1, 1.0 / u_index[i]);
        vec3 P_2 = P_1 + d_V * T_1;
        vec3 N_2 = textureLod(u_back, viewToUv(u_lightView, P_2), 0.0).xyz;
        if (dot(N_2, N_2) == 0.0) N_2 = normalize(vec3(T_1.xy, 0.0));
        vec3 T_2 = refraction(T_1, -N_2, u_index[i]);
        T_2 /= -T_2.z;

        // Of two probes the better, then the distance iterated.
        float distance_ = 1000.0, deltaDist = 1000.0;
        for (float probe = 0.0; probe < 2.0; probe += 1.0) {
            float there = receiverDepth(P_2 + probe * T_2) + P_2.z;
            if (abs(there - probe) < deltaDist) {
                deltaDist = abs(there - probe);
                distance_ = probe;
            }
        }
        for (int k = 0; k < 5; ++k) distance_ = receiverDepth(P_2 + distance_ * T_2) + P_2.z;

        // Outside the view the rasteriser would drop the point; so goes what is not a number.
        vec2 at = viewToUv(u_lightView, P_2 + distance_ * T_2);
        if (!all(lessThan(abs(at - 0.5), vec2(0.5)))) continue;
        g_centre = at * vec2(u_mapSize);
        g_splat = u_weight[i] * (flux / texelExtent(u_lightView, at, 1.0 / vec2(u_mapSize)));
        gl_Position = vec4(2.0 * at - 1.0, 0.5, 1.0);
        EmitVertex();
        EndPrimitive();
    }
}
