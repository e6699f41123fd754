// Filtered lookup of a caster layer: xyz normal, w layer value (view.glsl). Bilinear over the texels that belong to the
// nearest one's surface, so that facets keep their edges and silhouettes do not bleed into nothing.
const float kSameSurfaceCos = 0.966;   // 15 degrees: neighbours of a smooth surface turn by far less

// False where no texel around `uv` holds a surface.
bool sampleLayer(sampler2D layer, vec2 uv, out vec4 value) {
    ivec2 size = textureSize(layer, 0);
    vec2 at = uv * vec2(size) - 0.5;
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    vec4 texel[4];
    float weight[4];
    float most = 0.0;
    vec4 nearest = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 offset = ivec2(i & 1, i >> 1);
        texel[i] = texelFetch(layer, clamp(base + offset, ivec2(0), size - 1), 0);
        vec2 share = mix(1.0 - f, f, vec2(offset));
        weight[i] = texel[i].w > 0.0 ? share.x * share.y + 1e-6 : 0.0;
        if (weight[i] > most) {
            most = weight[i];
            nearest = texel[i];
        }
    }
    if (most == 0.0) return false;
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < 4; ++i) {
        float w = dot(texel[i].xyz, nearest.xyz) > kSameSurfaceCos ? weight[i] : 0.0;
        sum += w * texel[i];
        total += w;
    }
    value = vec4(normalize(sum.xyz), sum.w / total);
    return true;
}
