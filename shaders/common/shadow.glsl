// Visibility from a view of depths. Reversed depth: a stored value above a point's own is something nearer the light.
#include "common/view.glsl"

// Change of the layer value over uv on the plane through `pos` with `normal` (any length), both in view space.
vec2 layerGradient(View view, vec3 pos, vec3 normal) {
    float d = isPerspective(view) ? dot(normal, pos) : -normal.z * (view.far - view.near);
    d = abs(d) < 1e-30 ? 1e-30 : d;
    return 2.0 * view.halfExtent * normal.xy * (isPerspective(view) ? view.near / d : 1.0 / d);
}

// The point's layer value, raised by what a texel of its own plane can hold above it within `texels` texels.
float raisedLayer(View view, vec3 pos, vec3 normal, vec2 texelSize, float texels) {
    float layer = isPerspective(view) ? view.near / max(-pos.z, 1e-20) : 1.0 - (-pos.z - view.near) / (view.far - view.near);
    float slope = texels * dot(abs(layerGradient(view, pos, normal)), texelSize);
    float rounding = 4e-5 * (isPerspective(view) ? layer : 1.0);  // of 32-bit depth and of the interpolated position
    return layer + rounding + min(slope, abs(layer) + rounding);
}

// 1 lit, 0 in shadow; outside the view everything is lit. One filtered tap: shadow texels are finer than pixels.
float visibility(sampler2DShadow depths, View view, vec3 pos, vec3 normal) {
    vec2 uv = viewToUv(view, pos);
    float layer = raisedLayer(view, pos, normal, 1.0 / vec2(textureSize(depths, 0)), 1.0);
    bool inside = all(lessThan(abs(uv - 0.5), vec2(0.5))) && (!isPerspective(view) || pos.z < 0.0);
    return inside ? 1.0 - texture(depths, vec3(uv, layer)) : 1.0;
}
