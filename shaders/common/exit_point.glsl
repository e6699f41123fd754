// Where a ray inside a caster leaves it: Newton on the back layer, that is, the ray meets the plane of the layer's point
// and normal under its last guess. Exact on flat faces after one step (Wyman 2005 takes one distance instead).

// `t` starts as a guess and ends at the exit; `normal` is the outward unit normal there. False when it does not settle
// within `tolerance` (length).
bool findExit(View view, sampler2D back, vec3 origin, vec3 direction, int steps, float tolerance, float deeper,
              inout float t, out vec3 normal) {
    float last = 0.0;             // the last distance that had a surface under it
    float change = 1e30;
    normal = vec3(0.0);
    for (int i = 0; i < steps; ++i) {
        vec2 uv = viewToUv(view, origin + t * direction);
        vec4 layer;
        if (any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0))) || !sampleLayer(back, uv, layer)) {
            t = 0.5 * (t + last);   // beyond the silhouette: half way back
            continue;
        }
        float towards = dot(direction, layer.xyz);
        if (towards < 1e-4) {       // the surface under the guess faces the ray: deeper where it is not out yet, else nearer
            t = layerOf(view, origin + t * direction) > layer.w ? (t < deeper ? deeper : 2.0 * t) : 0.5 * (t + last);
            continue;
        }
        float met = dot(layerToView(view, uv, layer.w) - origin, layer.xyz) / towards;
        normal = layer.xyz;
        change = abs(met - t);
        last = t;
        t = max(met, 0.0);
    }
#if RESIDUALS
    countResidual(steps > 1 ? kResidualExit : kResidualExitFollowed, change / tolerance);
#endif
    return change <= tolerance;
}
