// Twin of server/render/view.h: the camera's view and every view from the light. Depth z = -view.z > 0.
// A layer value is what the depth buffer holds: near / z (perspective) or 1 at near to 0 at far (parallel); 0 is nothing.
// kViews: what a program's views are, where that is known: 1 perspective, 2 parallel; else each says so itself.
#ifndef kViews
#define kViews 0
#endif

struct View {
    mat4 worldToView;   // rigid
    vec2 halfExtent;    // tangents (perspective) or metres (parallel)
    float near;
    float far;
    bool perspective;
};

#if kViews == 0
#define isPerspective(view) view.perspective
#else
#define isPerspective(view) (kViews == 1)
#endif

vec2 viewToUv(View view, vec3 pos) {
    vec2 xy = isPerspective(view) ? pos.xy / -pos.z : pos.xy;
    return 0.5 + 0.5 * xy / view.halfExtent;
}

float layerToDepth(View view, float layer) {
    return isPerspective(view) ? view.near / max(layer, 1e-30) : view.near + (1.0 - layer) * (view.far - view.near);
}

// Layer value of a view-space point.
float layerOf(View view, vec3 pos) {
    return isPerspective(view) ? view.near / max(-pos.z, 1e-30) : 1.0 - (-pos.z - view.near) / (view.far - view.near);
}

// View-space point of the layer value at `uv`.
vec3 layerToView(View view, vec2 uv, float layer) {
    float z = layerToDepth(view, layer);
    vec2 xy = (2.0 * uv - 1.0) * view.halfExtent;
    return vec3(isPerspective(view) ? xy * z : xy, -z);
}

// How far a view-space point lies behind (> 0) or before (< 0) the layer, relative to its depth (perspective) or to the
// depth range (parallel). Linear along a ray on any plane. Nothing in the layer: before.
float behindLayer(View view, vec3 pos, float layer) {
    if (isPerspective(view)) return -pos.z * layer / view.near - 1.0;
    return layer <= 0.0 ? -1.0 : (-pos.z - view.near) / (view.far - view.near) - (1.0 - layer);
}

// Unit view-space direction of the light or sight at `uv`.
vec3 viewDirection(View view, vec2 uv) {
    return isPerspective(view) ? normalize(vec3((2.0 * uv - 1.0) * view.halfExtent, -1.0)) : vec3(0.0, 0.0, -1.0);
}

// Solid angle (perspective) or area (parallel) of one texel of `texelSize` = 1 / resolution at `uv`.
float texelExtent(View view, vec2 uv, vec2 texelSize) {
    vec2 size = 2.0 * view.halfExtent * texelSize;
    if (!isPerspective(view)) return size.x * size.y;
    vec2 xy = (2.0 * uv - 1.0) * view.halfExtent;
    float r2 = 1.0 + dot(xy, xy);
    return size.x * size.y * inversesqrt(r2 * r2 * r2);
}
