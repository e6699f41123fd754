// A caster as the camera sees it. A few nodes (exact indices, from the lowest to the highest) are traced: refract at the
// front layer, walk to the back layer, refract out, search the receivers' picture. Wavelengths between two nodes look
// where interpolation puts them, each with its own colour and absorption: the cost hardly grows with their number. What
// reflects inside (all of it beyond the critical angle) goes on through both layers for a few bounces, as one ray of mean
// direction or, with SPLIT, as one ray for each node, which is where a gem's fire comes from. Every share ends in some
// colour, so shares always sum to 1: no black holes.
#include "common/lights.glsl"
#include "common/optics.glsl"
#include "common/picture.glsl"
uniform sampler2D u_front, u_back;     // xyz outward normal, w layer value; undefined outside u_box
uniform vec4 u_box;                    // uv: lowest and highest place a filtered lookup may be made
uniform float u_diameter;              // no way through the caster is longer, m
uniform Light u_key;                   // position and direction in view space; rgb over the reference irradiance
#if THIN
uniform vec3 u_tint;
#else
uniform int u_backSteps;               // Newton steps of the first way through
uniform int u_bounces;                 // interfaces met after the second
uniform int u_nodeCount;
uniform vec4 u_nodes[8];               // relative index, absorption (1/m), wavelengths up to it: first, one past the last
uniform vec4 u_wavelengths[64];        // rgb weight; place between its nodes, 0..1
#if ABSORPTION
uniform float u_absorption[64];        // 1/m

float transmittance(float perM, float length_) { return exp(-perM * length_); }
#endif
#endif
const float kOrderlySpread = 0.08;     // radians from one pixel to the next
layout(location = 0) out vec4 o_radiance;

// The key light in the front surface: a tight lobe of bounded height around the mirror direction.
vec3 keyHighlight(vec3 pos, vec3 mirrored, vec3 reflectance) {
    vec4 to = towardsLight(u_key, pos);
    float lobe = exp(-900.0 * (1.0 - dot(mirrored, to.xyz)));  // about 3 degrees across
    vec3 irradiance = u_key.rgb * to.w * coneFactor(u_key, to.xyz);
    return min(irradiance, vec3(4.0)) * reflectance * (60.0 * lobe);
}

#if !THIN
// Newton on a layer's planes from `t` on, nearest texels: off by no more than the surface bends within half a texel. The
// normal decides where the ray goes on, so it is filtered; empty texels hold zeros and drop out. False when no exit lies
// ahead. `change`: what the last step still changed, m.
bool walk(sampler2D layer, vec3 pos, vec3 dir, int steps, inout float t, out vec3 normal, out float change) {
    bool found = false;
    change = 0.0;
    vec2 size = vec2(textureSize(layer, 0)), texel;
    for (int i = 0; i < steps; ++i) {
        texel = floor(clamp(viewToUv(u_view, pos + t * dir), u_box.xy, u_box.zw) * size);
        vec4 at = texelFetch(layer, ivec2(texel), 0);
        float slope = dot(dir, at.xyz);
        bool surface = at.w > 0.0 && slope > 1e-3;
        float next = dot(layerToView(u_view, (texel + 0.5) / size, at.w) - pos, at.xyz) / slope;
        next = surface ? clamp(next, 0.0, u_diameter) : 0.6 * t;
        change = abs(next - t);
        t = next;
        found = found || surface;
    }
    normal = textureLod(layer, clamp(viewToUv(u_view, pos + t * dir), u_box.xy, u_box.zw), 0.0).xyz;
    normal = normalize(normal + 1e-6 * dir);
    return found && t > 0.0 && dot(normal, dir) > 0.0;
}

struct Node {
    Sight sight;        // what is seen where the ray comes out
    vec3 exit, inside;  // last point and direction inside
    vec3 normal;        // outward, there
    float front, back;  // reflectances
    float length_;      // of the way through, m
};

Node traceNode(float index, vec3 pos, vec3 dir, vec3 normal, float guess) {
    Node node;
    vec3 outside;
    float change;
    refractDielectric(dir, normal, 1.0 / index, node.inside, node.front);
    node.inside = node.front < 1.0 ? node.inside : dir;
    node.length_ = guess;
    bool found = walk(u_back, pos, node.inside, u_backSteps, node.length_, node.normal, change);
    node.normal = found ? node.normal : -normal;  // no way through that the layers know: a thin plate's
    node.exit = pos + node.length_ * node.inside;
    bool leaves = refractDielectric(node.inside, -node.normal, index, outside, node.back);
    node.sight = look(node.exit, leaves ? outside : node.inside);
    return node;
}

// The share `kept` of the light, still inside at `at` and on its way along `dir`: bounces until it is out. Where
// neighbouring pixels part ways (a bumpy body) a bounce would only be noise: the mean of the surroundings is right there.
vec3 follow(vec3 kept, vec3 at, vec3 dir, float index, float absorption) {
    vec2 spread = vec2(length(dFdx(dir)), length(dFdy(dir)));
    float orderly = 1.0 - smoothstep(kOrderlySpread, 3.0 * kOrderlySpread, max(spread.x, spread.y));
    vec3 color = kept * (1.0 - orderly) * surroundings(dir);
    kept *= orderly;
    for (int bounce = 0; bounce < u_bounces; ++bounce) {
        float toFront = 0.4 * u_diameter, toBack = toFront, changeFront, changeBack, R;
        vec3 frontNormal, backNormal, outside;
        bool onFront = walk(u_front, at, dir, 3, toFront, frontNormal, changeFront) && toFront > 1e-3 * u_diameter;
        bool onBack = walk(u_back, at, dir, 3, toBack, backNormal, changeBack) && toBack > 1e-3 * u_diameter;
        if (!(onFront || onBack)) break;
        bool takesFront = onFront && (!onBack || toFront < toBack);
        float t = takesFront ? toFront : toBack, change = takesFront ? changeFront : changeBack;
        float settled = 1.0 - smoothstep(0.002, 0.02, change / u_diameter);
        color += kept * (1.0 - settled) * surroundings(dir);
        kept *= settled;
        vec3 exitNormal = takesFront ? frontNormal : backNormal;
        at += t * dir;
#if ABSORPTION
        kept *= transmittance(absorption, t);
#endif
        if (refractDielectric(dir, -exitNormal, index, outside, R)) {
            Sight seen = look(at, outside);
            color += kept * (1.0 - R) * radiance(seen, seen, 0.0);
        }
        kept *= R;
        dir = reflect(dir, exitNormal);
        if (max(kept.r, max(kept.g, kept.b)) < 0.02) break;
    }
    return color + kept * surroundings(dir);
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 front = texelFetch(u_front, pixel, 0);
    if (front.w <= texelFetch(u_receiversDepth, pixel, 0).r) discard;

    // An interpolated normal may turn away at the silhouette; it is bent back until it grazes.
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(u_background, 0));
    vec3 pos = layerToView(u_view, uv, front.w), sight = viewDirection(u_view, uv);
    vec3 normal = normalize(front.xyz - sight * max(dot(front.xyz, sight) + 0.02, 0.0));
    vec3 mirrored = reflect(sight, normal), color = vec3(0.0);

#if THIN
    vec3 inside;
    float surface;
    refractDielectric(sight, normal, 1.0 / 1.5, inside, surface);
    vec3 reflected = vec3(2.0 * surface / (1.0 + surface));  // two faces of a plate and all reflections between them
    color += texelFetch(u_background, pixel, 0).rgb * u_tint * (1.0 - reflected);
#else
    // First guess of the way through: straight on.
    float backLayer = texelFetch(u_back, pixel, 0).w;
    float through = (layerToDepth(u_view, backLayer) + pos.z) / max(-sight.z, 1e-3);
    float guess = backLayer > 0.0 && through > 0.0 ? min(through, u_diameter) : 0.05 * u_diameter;

#if SINGLE
    Node node = traceNode(u_nodes[0].x, pos, sight, normal, guess);
    vec3 reflected = u_wavelengths[0].rgb * node.front, arriving = u_wavelengths[0].rgb - reflected;
#if ABSORPTION
    arriving *= transmittance(u_nodes[0].y, node.length_);
#endif
    color += arriving * (1.0 - node.back) * radiance(node.sight, node.sight, 0.0);
    color += follow(arriving * node.back, node.exit, reflect(node.inside, node.normal), u_nodes[0].x, u_nodes[0].y);
#else
    // From node to node, and the wavelengths between.
    vec3 reflected = vec3(0.0), kept = vec3(0.0);
    vec4 meanExit = vec4(0.0);      // of what stays inside, by weight; w: the weights' sum
    vec3 meanDir = vec3(0.0);
    vec2 meanGlass = vec2(0.0);     // index, absorption
    Node a, b;
    for (int n = 0; n < u_nodeCount; ++n) {
        a = b;
        b = traceNode(u_nodes[n].x, pos, sight, normal, guess);
        if (n == 0) a = b;
        Sight from = a.back < 1.0 ? a.sight : b.sight, to = b.back < 1.0 ? b.sight : a.sight;
        bool together = distance(from.uv, to.uv) < 0.15;
        float nodeWeight = 1e-9;
        for (int i = int(u_nodes[n].z); i < int(u_nodes[n].w); ++i) {
            float f = u_wavelengths[i].w, R1 = mix(a.front, b.front, f), R2 = mix(a.back, b.back, f);
            vec3 weight = u_wavelengths[i].rgb;
            vec3 arriving = weight * (1.0 - R1);
#if ABSORPTION
            arriving *= transmittance(u_absorption[i], mix(a.length_, b.length_, f));
#endif
            reflected += weight * R1;
            color += arriving * (1.0 - R2) * radiance(from, to, together ? f : step(0.5, f));
            kept += arriving * R2;
            nodeWeight += R2;
        }
#if SPLIT
        color += follow(kept, b.exit, reflect(b.inside, b.normal), u_nodes[n].x, u_nodes[n].y);
        kept = vec3(0.0);
#else
        meanExit += nodeWeight * vec4(b.exit, 1.0);
        meanDir += nodeWeight * reflect(b.inside, b.normal);
        meanGlass += nodeWeight * u_nodes[n].xy;
#endif
    }
#if !SPLIT
    meanGlass /= meanExit.w;
    color += follow(kept, meanExit.xyz / meanExit.w, normalize(meanDir + 1e-9 * sight), meanGlass.x, meanGlass.y);
#endif
#endif
#endif
#if SPLIT
    Sight mirror = look(pos, mirrored);
#else
    Sight mirror = Sight(vec2(0.5), 1.0, surroundings(mirrored));   // a few per cent of the light: blurred while it moves
#endif
    color += reflected * radiance(mirror, mirror, 0.0) + keyHighlight(pos, mirrored, reflected);
    o_radiance = vec4(clamp(color, vec3(-6e4), vec3(6e4)), 1.0);
}
