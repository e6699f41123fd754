// Rays into the camera's own picture of the receivers: what one sees along a ray that left a caster.
#include "common/view.glsl"
uniform View u_view;
uniform sampler2D u_background;       // linear radiance
uniform sampler2D u_receiversDepth;   // layer value
uniform sampler2D u_surroundings;     // 8 x 8 means of the background
uniform int u_receiverSteps;
const int kMarches = 4;

// A plausible, bounded answer for a ray that meets nothing the picture shows: the picture's colours, blurred, with
// straight ahead in the middle and sideways at the border; behind the eye mirrored.
vec3 surroundings(vec3 dir) { return textureLod(u_surroundings, 0.5 + 0.5 * dir.xy / (1.0 + abs(dir.z)), 0.0).rgb; }

// uv and layer value: linear along a ray in the image, 0 at infinity.
vec3 toImage(vec3 pos) {
    float layer = isPerspective(u_view) ? u_view.near / max(-pos.z, 1e-20)
                                     : 1.0 - (-pos.z - u_view.near) / (u_view.far - u_view.near);
    return vec3(viewToUv(u_view, pos), layer);
}

// How far a point of the image lies behind (> 0) the receivers there, in layer values.
float behind(vec3 at) { return textureLod(u_receiversDepth, at.xy, 0.0).r - at.z; }

// Where the ray leaves the picture's frustum; `endless` when it never does.
vec3 frustumEnd(vec3 pos, vec3 dir, out bool endless) {
    float z = isPerspective(u_view) ? -pos.z : 1.0, dz = isPerspective(u_view) ? -dir.z : 0.0;
    vec4 room = vec4(u_view.halfExtent * z - pos.xy, u_view.halfExtent * z + pos.xy);
    vec4 change = vec4(u_view.halfExtent * dz - dir.xy, u_view.halfExtent * dz + dir.xy);
    float length_ = 1e30;
    for (int i = 0; i < 4; ++i) length_ = change[i] < 0.0 ? min(length_, max(room[i], 0.0) / -change[i]) : length_;
    float toNear = -pos.z - u_view.near, toFar = u_view.far + pos.z;
    if (dir.z > 0.0) length_ = min(length_, max(toNear, 0.0) / dir.z);
    if (!isPerspective(u_view) && dir.z < 0.0) length_ = min(length_, max(toFar, 0.0) / -dir.z);
    endless = length_ > 1e29;
    return endless ? vec3(viewToUv(u_view, dir), 0.0) : toImage(pos + length_ * dir);
}

// Where a ray looks: a place in the picture, and how far (`astray` 1: quite) it is out of it, where `fallback` stands in.
struct Sight {
    vec2 uv;
    float astray;
    vec3 fallback;
};

// A few samples find the first crossing, a bracketed secant (Illinois) settles on it: behind() is linear along a ray over
// any plane.
Sight look(vec3 pos, vec3 dir) {
    bool endless;
    vec3 start = toImage(pos), end = frustumEnd(pos, dir, endless);
    bool inPicture = all(lessThanEqual(abs(start.xy - 0.5), vec2(0.5)));
    vec3 a = start, b = start;
    float fa = behind(start), fb = fa, side = 0.0;
    for (int i = 1; i <= kMarches; ++i) {
        vec3 next = mix(start, end, float(i) / float(kMarches));
        float f = behind(next);
        bool before = fb < 0.0;
        a = before ? b : a;
        fa = before ? fb : fa;
        b = before ? next : b;
        fb = before ? f : fb;
    }
    // Nothing crossed: the end it is. A ray that leaves just before it would have met something looks at the border; the
    // further off, the less.
    bool leaves = fb < 0.0 && !endless;
    float astray = leaves ? clamp(-1.5 * fb / max(end.z, 1e-20), 0.0, 1.0) : 0.0;
    bool search = fa < 0.0 && fb > 0.0;
    vec3 hit = b;
    for (int i = 0; i < u_receiverSteps; ++i) {
        hit = search ? mix(a, b, fa / (fa - fb)) : hit;
        float f = behind(hit);
        bool before = f < 0.0;
        a = before ? hit : a;
        b = before ? b : hit;
        fb = before ? (side < 0.0 ? 0.5 * fb : fb) : f;
        fa = before ? f : (side > 0.0 ? 0.5 * fa : fa);
        side = before ? -1.0 : 1.0;
    }
    return Sight(hit.xy, inPicture ? astray : 1.0, surroundings(dir));
}

// What is seen at `f` of the way from one sight to another.
vec3 radiance(Sight from, Sight to, float f) {
    vec3 seen = textureLod(u_background, mix(from.uv, to.uv, f), 0.0).rgb;
    return mix(seen, mix(from.fallback, to.fallback, f), mix(from.astray, to.astray, f));
}
