// A caster as the camera sees it. Per wavelength: refract at the front layer, walk to the back layer, absorb, refract out,
// look into the receivers' picture. What reflects inside (all of it beyond the critical angle) goes on as one ray of mean
// direction through both layers for a few bounces; every share ends in some colour, so shares always sum to 1.
#include "common/view.glsl"
#include "common/optics.glsl"
#include "common/layer.glsl"
#include "common/picture.glsl"
#include "common/lights.glsl"
const int kBounces = 3;
const int kBounceSteps = 3;            // Newton steps of one bounce
uniform sampler2D u_front, u_back;     // xyz outward normal, w layer value; undefined outside u_box
uniform vec4 u_box;                    // uv: lowest and highest place a filtered lookup may be made
uniform int u_backSteps;
uniform float u_diameter;              // no way through the caster is longer, m
uniform Light u_key;                   // position and direction in view space; rgb over the reference irradiance
#if THIN
uniform vec3 u_tint;
#else
uniform int u_count;
uniform vec4 u_wavelengths[64];        // rgb weight, relative index
uniform float u_absorption[64];        // 1/m
#endif
layout(location = 0) out vec4 o_radiance;

// Newton on a layer's planes from `t` on; false when no exit lies ahead. `normal` is the outward normal there.
bool walk(sampler2D layer, vec3 pos, vec3 dir, int steps, inout float t, out vec3 normal) {
    bool found = false;
    normal = -dir;
    for (int i = 0; i < steps; ++i) {
        vec2 uv = clamp(viewToUv(u_view, pos + t * dir), u_box.xy, u_box.zw);
        vec4 at;
        bool surface = sampleLayer(layer, uv, at);
        float slope = dot(dir, at.xyz);
        surface = surface && slope > 1e-3;
        float next = dot(layerToView(u_view, uv, at.w) - pos, at.xyz) / slope;
        normal = surface ? at.xyz : normal;
        found = found || surface;
        t = surface ? clamp(next, 0.0, u_diameter) : 0.6 * t;
    }
    return found && t > 0.0;
}

// The key light in the front surface: a tight lobe of bounded height around the mirror direction.
vec3 keyHighlight(vec3 pos, vec3 mirrored, float reflectance) {
    vec4 to = towardsLight(u_key, pos);
    float lobe = exp(-900.0 * (1.0 - dot(mirrored, to.xyz)));  // about 3 degrees across
    vec3 irradiance = u_key.rgb * to.w * coneFactor(u_key, to.xyz);
    return min(irradiance, vec3(4.0)) * (60.0 * reflectance * lobe);
}

void main() {
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(u_background, 0));
    vec4 front = texelFetch(u_front, ivec2(gl_FragCoord.xy), 0);
    if (front.w <= texelFetch(u_receiversDepth, ivec2(gl_FragCoord.xy), 0).r) discard;

    // An interpolated normal may turn away at the silhouette; it is bent back until it grazes.
    vec3 pos = layerToView(u_view, uv, front.w), sight = viewDirection(u_view, uv);
    vec3 normal = front.xyz;
    normal = normalize(normal - sight * max(dot(normal, sight) + 0.02, 0.0));
    vec3 mirrored = reflect(sight, normal);

#if THIN
    vec3 inside;
    float surface;
    refractDielectric(sight, normal, 1.0 / 1.5, inside, surface);
    float both = 2.0 * surface / (1.0 + surface);  // two faces of a plate, all reflections between them
    vec3 color = texelFetch(u_background, ivec2(gl_FragCoord.xy), 0).rgb * u_tint * (1.0 - both);
    color += both * seenAlong(pos, mirrored) + keyHighlight(pos, mirrored, both);
#else
    // First way through, wavelength by wavelength.
    vec4 back = texelFetch(u_back, ivec2(gl_FragCoord.xy), 0);
    float through = back.w > 0.0 ? max(layerToDepth(u_view, back.w) + pos.z, 0.0) : 0.0;
    float guess = through > 0.0 ? through / max(-sight.z, 1e-3) : 0.05 * u_diameter;
    vec3 color = vec3(0.0), reflected = vec3(0.0), kept = vec3(0.0);
    vec4 keptPos = vec4(0.0);                       // and their sum of weights, to find the mean ray
    vec3 keptDir = vec3(0.0);
    vec2 keptGlass = vec2(0.0);                     // index, absorption
    for (int i = 0; i < u_count; ++i) {
        vec3 weight = u_wavelengths[i].rgb;
        float index = u_wavelengths[i].w, R1, R2, t = guess;
        vec3 inside, outside, exitNormal;
        refractDielectric(sight, normal, 1.0 / index, inside, R1);
        reflected += weight * R1;
        if (R1 >= 1.0) continue;
        bool found = walk(u_back, pos, inside, u_backSteps, t, exitNormal);
        vec3 exit = pos + t * inside;
        if (!found) exitNormal = -normal;           // no way through that the layers know: a thin plate's
        bool leaves = refractDielectric(inside, -exitNormal, index, outside, R2);
        vec3 arriving = weight * (1.0 - R1) * exp(-u_absorption[i] * t);
        color += arriving * (1.0 - R2) * seenAlong(exit, leaves ? outside : inside);
        kept += arriving * R2;
        float share = max(dot(abs(arriving), vec3(1.0)) * R2, 1e-12);
        keptPos += share * vec4(exit, 1.0);
        keptDir += share * reflect(inside, exitNormal);
        keptGlass += share * vec2(index, u_absorption[i]);
    }

    // What is still inside, as one ray.
    vec3 at = keptPos.xyz / max(keptPos.w, 1e-20), dir = normalize(keptDir + 1e-20 * sight);
    float index = keptGlass.x / max(keptPos.w, 1e-20), absorption = keptGlass.y / max(keptPos.w, 1e-20);
    for (int bounce = 0; bounce < kBounces; ++bounce) {
        float toFront = 0.4 * u_diameter, toBack = toFront, R;
        vec3 frontNormal, backNormal, outside;
        bool onFront = walk(u_front, at, dir, kBounceSteps, toFront, frontNormal) && toFront > 1e-3 * u_diameter;
        bool onBack = walk(u_back, at, dir, kBounceSteps, toBack, backNormal) && toBack > 1e-3 * u_diameter;
        if (!onFront && !onBack) break;
        bool takesFront = onFront && (!onBack || toFront < toBack);
        float t = takesFront ? toFront : toBack;
        vec3 exitNormal = takesFront ? frontNormal : backNormal;
        at += t * dir;
        kept *= exp(-absorption * t);
        if (refractDielectric(dir, -exitNormal, index, outside, R)) color += kept * (1.0 - R) * seenAlong(at, outside);
        kept *= R;
        dir = reflect(dir, exitNormal);
    }
    color += kept * surroundings(dir);
    color += reflected * seenAlong(pos, mirrored) + keyHighlight(pos, mirrored, dot(reflected, vec3(1.0 / 3.0)));
#endif
    o_radiance = vec4(clamp(color, vec3(-6e4), vec3(6e4)), 1.0);
}
