// The receivers with their textures, point by point.
#include "common/receiver_shading.glsl"
in vec3 v_world, v_normal;
uniform vec3 u_baseColor, u_emissive;
#if TEXTURE
in vec2 v_uv;
uniform sampler2D u_baseColorTexture;
#endif
#if SHADOW
in vec3 v_shadow;
#endif
#if MAP
in vec3 v_map;
#endif
#if FULL
uniform float u_roughness, u_metallic, u_gloss;
#endif
layout(location = 0) out vec4 o_radiance;

void main() {
    Receiver at;
    at.world = v_world;
    // Receivers have two sides: the normal is that of the one that is seen.
    at.normal = gl_FrontFacing ? v_normal : -v_normal;
    at.normal *= inversesqrt(max(dot(at.normal, at.normal), 1e-20));
    at.base = u_baseColor;
    at.emissive = u_emissive;
#if TEXTURE
    at.base *= texture(u_baseColorTexture, v_uv).rgb;
#endif
#if SHADOW
    at.shadow = v_shadow;
    at.shadowNormal = cross(dFdx(v_shadow), dFdy(v_shadow));
#endif
#if MAP
    at.map = v_map;
#endif
#if FULL
    at.roughness = u_roughness;
    at.metallic = u_metallic;
    at.gloss = u_gloss;
#endif
    o_radiance = vec4(shade(at), 1.0);
}
