// The casters as the camera sees them, exactly: a few wavelengths a pixel, each followed through every surface of every
// caster until it leaves for a receiver or for the environment. Pixels and frames differ in the wavelengths that they
// take, so that neighbours and a mean of frames hold the whole spectrum. Every share of the light ends in some colour,
// and a pixel's wavelengths are balanced to white: white surroundings stay white. KNOWN: samples of the same pixel came
// before.
#include "common/receiver_shading.glsl"
#include "common/optics.glsl"
#include "common/surfaces.glsl"
#include "common/interfaces.glsl"
#include "common/sight.glsl"
uniform mat4 u_viewToWorld;
uniform mat3 u_xyzToRgb;
uniform int u_rays;          // wavelengths a pixel
uniform int u_entries;       // of the spectral table
uniform float u_entryShare;  // of the light, that the colour of an entry is for
uniform float u_rotation;    // 0..1, of the wavelengths
uniform int u_bounces;       // reflections that are followed
uniform float u_least;       // weaker shares go the stronger one's way
uniform int u_branches;      // that may wait: where a ray has parted as often, it goes one of both ways with all its light
uniform int u_sample;        // which way that is differs from sample to sample; 0: the stronger one's
#if KNOWN
uniform sampler2D u_mean;    // of the samples before
#endif
#if DRAWN
in vec3 v_world, v_normal;
#endif
layout(location = 0) out vec4 o_radiance;

#if LONE
// Inside the only caster, which is convex: what leaves it does not come back. What is still inside after the last bounce
// goes on as if nothing were in its way.
vec3 throughGlass(int entry, int caster, vec3 at, vec3 way) {
    vec4 glass = glassAt(entry, caster);
    float eta = glass.x / u_outsideIndex, kept = 1.0, t;
    vec3 color = vec3(0.0);
    for (int bounce = 0; bounce <= u_bounces && kept > u_least; ++bounce) {
        Surface exit = exitOf(caster, at, way);
        at = exit.point;
        kept *= exp(-glass.y * exit.t);
        vec3 outside;
        float R;
        bool leaves = refractDielectric(way, -exit.geometric, eta, outside, R);
        bool last = bounce == u_bounces || kept * R <= u_least;
        outside = leaves ? outside : way;
        float share = kept * (last ? 1.0 : 1.0 - R);
        if (share > 0.0) color += share * (sightAlong(at, outside, t) + lampAlong(at, outside, t));
        kept -= share;
        way = reflect(way, exit.geometric);
    }
    return color;
}

// The radiance at one wavelength, without what the first surface reflects; the share of that.
vec3 follow(vec3 origin, vec3 direction, Surface surface, int entry, out float reflected) {
    reflected = 0.0;
    if (dot(direction, surface.geometric) > 0.0) return throughGlass(entry, surface.caster, origin, direction);
    Crossing c = crossingAt(surface, direction, outsideAll(), entry);
    reflected = c.reflectance;
    if (c.mirror) return vec3(0.0);
    return (1.0 - reflected) * throughGlass(entry, surface.caster, surface.point, c.transmitted);
}
#else
struct Branch {
    vec3 origin, direction;
    float weight;
    Inside inside;
    int piece;            // that it starts on
    int bounces;          // reflections so far; past u_bounces casters are in no ray's way
};
const int kMostBranches = 6;

// 0..1. O'Neill 2014, PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for Random Number
// Generation, as the hash of Jarzynski and Olano 2020.
float chance(inout uint state) {
    state = state * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return float(((word >> 22u) ^ word) >> 8) * (1.0 / 16777216.0);
}

vec3 follow(vec3 origin, vec3 direction, Surface surface, int entry, uint state) {
    Branch waiting[kMostBranches];
    int count = 0, steps = 8 * (u_bounces + 4);
    Branch now = Branch(origin, direction, 1.0, outsideAll(), -1, 0);
    bool first = true;
    vec3 color = vec3(0.0);
    while (true) {
        bool free = now.bounces > u_bounces || --steps < 0;
        if (!first && !free) surface = nearestSurface(now.origin, now.direction, now.piece, now.inside.casters);
        free = free || surface.caster < 0;
        int medium = mediumOf(now.inside);
        bool ended = false;
        if (!first && (medium == kOutside || free)) {
            float t;
            vec3 seen = sightAlong(now.origin, now.direction, t);
            ended = free || t < surface.t;
            if (ended) color += now.weight * (seen + lampAlong(now.origin, now.direction, t));
        }
        first = false;
        if (!ended) {
            Crossing c = crossingAt(surface, now.direction, now.inside, entry);
            float weight = now.weight * exp(-absorptionOf(entry, medium) * surface.t);
            float back = c.straight ? 0.0 : weight * c.reflectance, on = c.mirror ? 0.0 : weight - back;
            vec3 ahead = c.straight ? now.direction : c.transmitted;
            // Both ways, or all the light one of them.
            if (!c.mirror && (min(back, on) <= u_least || count >= u_branches || now.bounces >= u_bounces)) {
                float all = back + on;
                bool goesBack = u_sample > 0 ? chance(state) * all < back : back > on;
                goesBack = on <= 0.0 || (goesBack && now.bounces < u_bounces);
                back = goesBack ? all : 0.0;
                on = goesBack ? 0.0 : all;
            }
            Branch reflected = Branch(surface.point, c.reflected, back, now.inside, surface.piece, now.bounces + 1);
            now = Branch(surface.point, ahead, on, c.beyond, surface.piece, now.bounces);
            if (back > 0.0 && on > 0.0) {
                waiting[count] = reflected;
                ++count;
            } else if (back > 0.0) {
                now = reflected;
            } else if (on <= 0.0) {
                ended = true;
            }
        }
        if (ended) {
            if (count == 0) return color;
            --count;
            now = waiting[count];
        }
    }
}
#endif

// A pattern that looks like noise, but whose neighbours differ: Jimenez 2014, Next Generation Post Processing in Call of
// Duty: Advanced Warfare, "interleaved gradient noise".
float patternAt(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
#if DRAWN
    vec3 origin = u_eye.xyz, way = v_world - origin, direction = normalize(way), normal = normalize(v_normal);
    Surface surface = Surface(length(way), 0, -1, v_world, normal, normal);
#else
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(u_background, 0)) - u_shift;
    vec3 start = u_view.perspective ? vec3(0.0) : vec3((2.0 * uv - 1.0) * u_view.halfExtent, 0.0);
    vec3 origin = (u_viewToWorld * vec4(start, 1.0)).xyz, direction = mat3(u_viewToWorld) * viewDirection(u_view, uv);
    Surface surface = nearestSurface(origin, direction, -1);
    if (surface.caster < 0) discard;
#endif
    vec3 pos = (u_view.worldToView * vec4(surface.point, 1.0)).xyz;
    if (-pos.z < u_view.near || layerOf(u_view, pos) <= texelFetch(u_receiversDepth, pixel, 0).r) discard;

    float place = fract(u_rotation + patternAt(gl_FragCoord.xy)), share = 1.0 / float(u_rays);
    vec3 color = vec3(0.0), mean = vec3(0.0), white = vec3(0.0), mirrored = vec3(0.0);
    float meanMirrored = 0.0;
    for (int k = 0; k < u_rays; ++k) {
        int entry = min(int((float(k) + place) * share * float(u_entries)), u_entries - 1);
        vec3 weight = u_xyzToRgb * texelFetch(u_colours, entry).xyz * (u_entryShare * share);
#if LONE
        float R;
        vec3 seen = follow(origin, direction, surface, entry, R);
        mirrored += weight * R;
        meanMirrored += share * R;
#else
        uint state = uint(pixel.x + 8192 * pixel.y) * 9781u + uint(u_sample * 64 + k) * 6271u;
        chance(state);
        vec3 seen = follow(origin, direction, surface, entry, state);
#endif
        color += weight * seen;
        mean += share * seen;
        white += weight;
    }
    // What the pixel's wavelengths lack to white has their mean radiance; better, that of all before, which does not hang
    // on these wavelengths: the mean over all frames is the whole spectrum's.
#if KNOWN
    color += (1.0 - white) * texelFetch(u_mean, pixel, 0).rgb;
#else
    color += (1.0 - white) * mean;
#endif
#if LONE
#if !KNOWN
    mirrored += (1.0 - white) * meanMirrored;
#endif
    vec3 ahead = reflect(direction, surface.shading);
    float t;
    if (meanMirrored > 0.0) color += mirrored * (sightAlong(surface.point, ahead, t) + lampAlong(surface.point, ahead, t));
#endif
    o_radiance = vec4(clamp(color, vec3(-6e4), vec3(6e4)), 1.0);
}
