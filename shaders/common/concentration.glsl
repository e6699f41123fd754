// The projected spectral map: light that casters bring to a point, 1 = as bright as direct light.
#include "common/shadow.glsl"

// Inner map, the coarse outer one around it, and a cross-fade of a few texels where they meet.
vec3 concentration(sampler2D inner, sampler2D outer, View innerView, View outerView, vec3 posInner, vec3 posOuter) {
    vec2 uv = viewToUv(innerView, posInner), uvOuter = viewToUv(outerView, posOuter);
    vec2 toBorder = (0.5 - abs(uv - 0.5)) * vec2(textureSize(inner, 0));
    float inside = clamp(min(toBorder.x, toBorder.y) / 4.0, 0.0, 1.0);
    bool inOuter = all(lessThan(abs(uvOuter - 0.5), vec2(0.5)));
    vec3 sum = (inOuter ? (1.0 - inside) * texture(outer, uvOuter).rgb : vec3(0.0)) + inside * texture(inner, uv).rgb;
    bool ahead = !innerView.perspective || posInner.z < 0.0;
    return ahead ? max(sum, vec3(0.0)) : vec3(0.0);
}
