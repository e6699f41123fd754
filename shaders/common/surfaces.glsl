// Nearest surfaces of a scene's casters and receivers, exactly (server/render/exact_surfaces.h binds what is read here).
// World space, metres. Flags, always 0 or 1: PLANES, MESHES, LONE, EXACT_RECEIVERS.
#include "common/hierarchy.glsl"

struct Surface {
    float t;
    int caster;        // -1: nothing met; kLost: not known
    int piece;         // plane or triangle, a number of its own among all casters'
    vec3 point;        // on the piece itself, nearer than origin + t * direction is
    vec3 geometric;    // unit, outward
    vec3 shading;      // interpolated, unit; the geometric one where they disagree about the ray's side
};

uniform int u_exactCasters;
uniform int u_firstTriangle;      // pieces below it are planes
uniform float u_exactReach;       // largest coordinate of a caster, m
#if PLANES
uniform samplerBuffer u_planes;   // a caster: first plane, planes; sphere; then planes around the spheres' centres
#endif
#if MESHES
uniform usamplerBuffer u_meshNodes;
uniform samplerBuffer u_meshCorners, u_meshNormals;
uniform Hierarchy u_mesh;
#endif
#if EXACT_RECEIVERS
uniform usamplerBuffer u_groundNodes;
uniform samplerBuffer u_groundCorners;
uniform Hierarchy u_ground;
#endif

const float kNowhere = 3e38;
const float kRoundings = 1e-6;    // of a coordinate: what a point on a surface may be off it by

// How far before its start a ray still meets what it starts on or has just passed by a rounding.
float roundingAround(vec3 origin) {
    vec3 size = abs(origin);
    return kRoundings * max(max(size.x, size.y), max(size.z, u_exactReach));
}

#if PLANES
Surface planeMet(vec3 origin, vec3 direction, int caster, int piece, float t) {
    vec3 centre = texelFetch(u_planes, 2 * caster + 1).xyz;
    vec4 plane = texelFetch(u_planes, piece);
    vec3 point = origin - centre + t * direction;
    point += (plane.w - dot(plane.xyz, point)) * plane.xyz;
    return Surface(t, caster, piece, centre + point, plane.xyz, plane.xyz);
}

// Seen from inside: the first plane of convex `caster` that the ray goes towards.
Surface exitOf(int caster, vec3 origin, vec3 direction) {
    vec2 range = texelFetch(u_planes, 2 * caster).xy;
    vec3 start = origin - texelFetch(u_planes, 2 * caster + 1).xyz;
    int first = int(range.x), end = first + int(range.y), nearest = first;
    float t = kNowhere;
    for (int i = first; i < end; ++i) {
        vec4 plane = texelFetch(u_planes, i);
        float along = dot(plane.xyz, direction), distance = (plane.w - dot(plane.xyz, start)) / along;
        if (along > 0.0 && distance < t) {
            t = distance;
            nearest = i;
        }
    }
    return planeMet(origin, direction, caster, nearest, max(t, 0.0));
}

// Narrows t, caster and piece to convex casters that are nearer. Left from within, entered from without; what starts on
// one's own plane outwards does not meet it again.
void meetPlanes(vec3 origin, vec3 direction, float least, int from, ivec4 inside, inout float t, inout int caster, inout int piece) {
    for (int c = 0; c < u_exactCasters; ++c) {
        vec2 range = texelFetch(u_planes, 2 * c).xy;
        vec4 sphere = texelFetch(u_planes, 2 * c + 1);
        vec3 start = origin - sphere.xyz;
        int first = int(range.x), end = first + int(range.y);
        bool own = from >= first && from < end;
        bool within = any(equal(inside, ivec4(c)));
#if !LONE
        float along = dot(start, direction);
        if (dot(start, start) - along * along > 1.0001 * sphere.w * sphere.w && !within) end = first;
#endif
        float enters = -kNowhere, leaves = kNowhere;
        int front = -1, back = -1;
        for (int i = first; i < end; ++i) {
            vec4 plane = texelFetch(u_planes, i);
            float along = dot(plane.xyz, direction), before = plane.w - dot(plane.xyz, start), distance = before / along;
            if (along > 0.0 && distance < leaves) {
                leaves = distance;
                back = i;
            }
            if (along < 0.0 && distance > enters) {
                enters = distance;
                front = i;
            }
            if (along == 0.0 && before < 0.0) enters = kNowhere;
        }
        if (inside == kAnywhere) within = own ? dot(texelFetch(u_planes, from).xyz, direction) < 0.0 : enters <= 0.0 && enters < leaves && leaves > 0.0;
        float distance = within ? max(leaves, 0.0) : enters;
        bool meets = within ? back >= 0 : front >= 0 && !own && enters < leaves && enters > least;
        if (meets && distance < t) {
            t = max(distance, 0.0);
            caster = c;
            piece = within ? back : front;
        }
    }
}
#endif

#if MESHES
Surface triangleMet(vec3 origin, vec3 direction, Met met) {
    vec3 a = texelFetch(u_meshCorners, 3 * met.triangle).xyz;
    vec3 ab = texelFetch(u_meshCorners, 3 * met.triangle + 1).xyz - a, ac = texelFetch(u_meshCorners, 3 * met.triangle + 2).xyz - a;
    // Moeller & Trumbore 1997, clamped: the triangle is the one that was met.
    vec3 area = cross(ab, ac), moved = cross(origin - a, direction);
    float along = dot(direction, area);
    float u = clamp(-dot(moved, ac) / along, 0.0, 1.0), v = clamp(dot(moved, ab) / along, 0.0, 1.0 - u);
    vec3 geometric = normalize(area);
    vec3 shading = (1.0 - u - v) * texelFetch(u_meshNormals, 3 * met.triangle).xyz +
                   u * texelFetch(u_meshNormals, 3 * met.triangle + 1).xyz + v * texelFetch(u_meshNormals, 3 * met.triangle + 2).xyz;
    float size = length(shading), side = dot(direction, shading) * along;
    shading = size > 1e-6 && side > 0.0 ? shading / size : geometric;
    return Surface(max(met.t, 0.0), int(met.number), u_firstTriangle + met.triangle, a + u * ab + v * ac, geometric, shading);
}
#endif

// Nearest caster along a ray that starts on piece `from` (-1: on none) and is in the casters `inside` (kAnywhere: not
// known; other values that are no caster's stand for empty places). With `inside`, a ray may start on the very surface,
// or a few roundings to either side of it: it meets what it starts in or touches, once, and never piece `from`.
Surface nearestSurface(vec3 origin, vec3 direction, int from, ivec4 inside) {
    float least = inside == kAnywhere ? 0.0 : -roundingAround(origin), t = kNowhere;
    int caster = -1, piece = -1;
#if PLANES
    meetPlanes(origin, direction, least, from, inside, t, caster, piece);
#endif
#if MESHES
    Met met = Met(t, -1, -1.0);
    meetHierarchy(u_meshNodes, u_meshCorners, u_mesh, origin, direction, least, from - u_firstTriangle, inside, met);
    if (met.triangle >= 0) return triangleMet(origin, direction, met);
    if (int(met.number) == kLost) return Surface(kNowhere, kLost, -1, origin, vec3(0.0), vec3(0.0));
#endif
#if PLANES
    if (caster >= 0) return planeMet(origin, direction, caster, piece, t);
#endif
    return Surface(kNowhere, -1, -1, origin, vec3(0.0), vec3(0.0));
}

Surface nearestSurface(vec3 origin, vec3 direction, int from) { return nearestSurface(origin, direction, from, kAnywhere); }

#if EXACT_RECEIVERS
struct Ground {
    float t;
    int object;        // index into Geometry::objects; -1: nothing; kLost: not known
    vec3 geometric;    // unit, outward; either side is met
};

// Also what the ray starts on or has passed by a rounding: a caster may stand on a receiver.
Ground nearestReceiver(vec3 origin, vec3 direction) {
    Met met = Met(kNowhere, -1, -1.0);
    meetHierarchy(u_groundNodes, u_groundCorners, u_ground, origin, direction, -roundingAround(origin), -1, kAnywhere, met);
    if (met.triangle < 0) return Ground(kNowhere, int(met.number), vec3(0.0));
    vec3 a = texelFetch(u_groundCorners, 3 * met.triangle).xyz;
    vec3 b = texelFetch(u_groundCorners, 3 * met.triangle + 1).xyz, c = texelFetch(u_groundCorners, 3 * met.triangle + 2).xyz;
    return Ground(max(met.t, 0.0), int(met.number), normalize(cross(b - a, c - a)));
}
#endif

// A point on a surface, moved off it to the side that `direction` goes to: Waechter & Binder 2019, A Fast and Robust
// Method for Avoiding Self-Intersection (Ray Tracing Gems 6), with their lengths in casters' sizes instead of metres.
// nearestSurface does not need it where it knows `inside`.
vec3 leaving(vec3 point, vec3 geometric, vec3 direction) {
    vec3 normal = dot(geometric, direction) < 0.0 ? -geometric : geometric;
    ivec3 steps = ivec3(256.0 * normal);
    vec3 moved = intBitsToFloat(floatBitsToInt(point) + mix(steps, -steps, lessThan(point, vec3(0.0))));
    float size = max(u_exactReach, 1e-30);
    return mix(moved, point + (size / 65536.0) * normal, lessThan(abs(point), vec3(size / 32.0)));
}
