// The projected spectral map: light that casters bring to a point, 1 = as bright as direct light.
#include "common/view.glsl"

// Sum of the inner map and the coarse outer one, which holds only what landed outside the inner. `outerScale`: inner over
// outer half extent. A map's alpha is the layer value of the receiver that its light lies on (1: unknown); what hides
// behind that receiver gets nothing.
vec3 concentration(sampler2D inner, sampler2D outer, View view, vec2 outerScale, vec3 pos) {
    vec2 offset = viewToUv(view, pos) - 0.5, outerOffset = offset * outerScale;
    vec4 fine = texture(inner, 0.5 + offset), coarse = texture(outer, 0.5 + outerOffset);
    bool inInner = all(lessThan(abs(offset), vec2(0.5)));
    bool inOuter = all(lessThan(abs(outerOffset), vec2(0.5))) && (!isPerspective(view) || pos.z < 0.0);
    vec3 sum = max(coarse.rgb + (inInner ? fine.rgb : vec3(0.0)), vec3(0.0));
    float layer = inInner ? fine.a : coarse.a;
    float hidden = layer < 1.0 ? behindLayer(view, pos, layer) : 0.0;
    return inOuter ? sum * clamp(3.0 - 100.0 * hidden, 0.0, 1.0) : vec3(0.0);  // fades from 2% to 3% behind
}

// Where nothing landed outside the inner map: the same without the outer one.
vec3 concentration(sampler2D inner, View view, vec3 pos) {
    vec2 offset = viewToUv(view, pos) - 0.5;
    vec4 fine = texture(inner, 0.5 + offset);
    bool inInner = all(lessThan(abs(offset), vec2(0.5))) && (!isPerspective(view) || pos.z < 0.0);
    float hidden = fine.a < 1.0 ? behindLayer(view, pos, fine.a) : 0.0;
    return inInner ? max(fine.rgb, vec3(0.0)) * clamp(3.0 - 100.0 * hidden, 0.0, 1.0) : vec3(0.0);
}
