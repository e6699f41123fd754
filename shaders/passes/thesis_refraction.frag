// Deferred refraction as printed (Blanchette 2012, appendix A): for each wavelength one ray through the caster's two
// layers and one fetch of the receivers' picture, with the printed constants.
#include "common/lights.glsl"
#include "common/view.glsl"
uniform View u_view;
uniform sampler2D u_front, u_back;     // xyz outward normal, w layer value
uniform sampler2D u_background;        // the receivers' picture
uniform sampler2D u_receiversDepth;    // layer value
uniform Light u_key;                   // position and direction in view space
uniform vec3 u_keyColour, u_environment;
uniform int u_count;
uniform vec4 u_wavelengths[64];        // rgb weight, summing to 1; index over that of what is around it
uniform float u_absorption[64];        // 1/m
layout(location = 0) out vec4 o_radiance;

float depthOf(float layer) { return min(layerToDepth(u_view, layer), u_view.far); }
float receiverDepth(vec3 pos) { return depthOf(textureLod(u_receiversDepth, viewToUv(u_view, pos), 0.0).r); }

vec3 refraction(vec3 incident, vec3 normal, float ratio) {
    float IdotN = dot(-incident, normal);
    float cosSqr = 1.0 - ratio * ratio * (1.0 - IdotN * IdotN);
    return cosSqr <= 0.0 ? normalize(reflect(incident, normal))
                         : normalize(ratio * incident + (ratio * IdotN - sqrt(cosSqr)) * normal);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 front = texelFetch(u_front, pixel, 0);
    if (front.w <= 0.0 || texelFetch(u_receiversDepth, pixel, 0).r > front.w) discard;   // the background stays

    vec2 uv = gl_FragCoord.xy / vec2(textureSize(u_background, 0));
    vec3 P_1 = layerToView(u_view, uv, front.w), V = viewDirection(u_view, uv), N_1 = normalize(front.xyz);

    // Schlick, and Phong's highlight of the key light.
    float oneMinus = 1.0 - dot(-V, N_1);
    float fresnel = 0.05 + 0.95 * oneMinus * oneMinus * oneMinus * oneMinus * oneMinus;
    vec3 toLight = towardsLight(u_key, P_1).xyz;
    float NdotH = max(0.0, dot(N_1, normalize(toLight - V)));
    float cone = coneFactor(u_key, toLight);
    vec3 spot = u_keyColour * (cone > 0.0 ? cone : 0.25);
    vec3 color = fresnel * (20.0 * pow(NdotH, 50.0) * spot + 2.0 * u_environment);

    float d_V = (depthOf(texelFetch(u_back, pixel, 0).w) + P_1.z) / -V.z;   // along the ray, see photon_splat.geom
    for (int i = 0; i < u_count; ++i) {
        float index = u_wavelengths[i].w;
        vec3 T_1 = refract(V, N_1, 1.0 / index);
        vec3 P_2 = P_1 + d_V * T_1;
        vec3 N_2 = textureLod(u_back, viewToUv(u_view, P_2), 0.0).xyz;
        if (dot(N_2, N_2) == 0.0) N_2 = vec3(T_1.xy, 0.0) / max(dot(T_1.xy, T_1.xy), 1e-12);   // printed without a bound
        vec3 T_2 = refraction(T_1, -N_2, index);
        T_2 /= abs(T_2.z) > 1e-6 ? -T_2.z : 1e-6;                                              // likewise

        float distance_ = 1000.0, deltaDist = 1000.0;
        for (float probe = 0.0; probe < 2.0; probe += 1.0) {
            float there = receiverDepth(P_2 + probe * T_2) + P_2.z;
            if (abs(there - probe) < deltaDist) {
                deltaDist = abs(there - probe);
                distance_ = probe;
            }
        }
        for (int k = 0; k < 10; ++k) distance_ = receiverDepth(P_2 + distance_ * T_2) + P_2.z;

        // Printed 0.26 times colours that sum to 3.5; these sum to 1.
        vec3 seen = textureLod(u_background, viewToUv(u_view, P_2 + distance_ * T_2), 0.0).rgb;
        color += 0.26 * 3.5 * (1.0 - fresnel) * exp(-d_V * u_absorption[i]) * u_wavelengths[i].rgb * seen;
    }
    o_radiance = vec4(clamp(color, vec3(-6e4), vec3(6e4)), 1.0);
}
