// L = albedo / pi * (E_key + E_others) + environment, in units of radianceUnit() (so pi is gone and lights come over the
// reference irradiance).   E_key = I cos / r^2 * (cone * cookie * visibility + concentration)
#include "common/lights.glsl"
#include "common/ggx.glsl"
#include "common/shadow.glsl"
#include "common/concentration.glsl"
in vec3 v_world, v_normal;
uniform vec4 u_eye;                 // world; w 0: an orthographic camera's direction instead, towards the eye
uniform Light u_lights[8];          // [0] throws the shadow and the map
uniform vec3 u_baseColor, u_emissive, u_environment;
#if TEXTURE
in vec2 v_uv;
uniform sampler2D u_baseColorTexture;
#endif
#if SHADOW
in vec3 v_shadow;
uniform View u_shadowView;
uniform sampler2DShadow u_shadowDepth;
#endif
#if MAP
in vec3 v_map;
uniform View u_mapView;
uniform vec2 u_outerScale;
uniform sampler2D u_map, u_outerMap;
#endif
#if FULL
uniform int u_lightCount;
uniform float u_roughness, u_metallic;
uniform float u_gloss;               // 0: Lambert alone
uniform bool u_hasCookie;
uniform View u_cookieView;
uniform sampler2D u_cookie;
#endif
layout(location = 0) out vec4 o_radiance;

void main() {
    // Receivers have two sides: the normal is that of the one that is seen.
    vec3 normal = gl_FrontFacing ? v_normal : -v_normal;
    normal *= inversesqrt(max(dot(normal, normal), 1e-20));

    vec3 base = u_baseColor;
#if TEXTURE
    base *= texture(u_baseColorTexture, v_uv).rgb;
#endif

    // Key light: what reaches the point directly, and what casters send there.
    vec4 toKey = towardsLight(u_lights[0], v_world);
    float cosKey = max(dot(normal, toKey.xyz), 0.0);
    float direct = coneFactor(u_lights[0], toKey.xyz);
#if SHADOW
    direct *= visibility(u_shadowDepth, u_shadowView, v_shadow, cross(dFdx(v_shadow), dFdy(v_shadow)));
#endif
    vec3 share = vec3(direct);
#if FULL
    vec2 cookieUv = viewToUv(u_cookieView, (u_cookieView.worldToView * vec4(v_world, 1.0)).xyz);
    vec3 cookie = texture(u_cookie, vec2(cookieUv.x, 1.0 - cookieUv.y)).rgb;
    if (u_hasCookie) share *= cookie;
#endif
#if MAP
    #if MAP == 2
    share += concentration(u_map, u_outerMap, u_mapView, u_outerScale, v_map);
#else
    share += concentration(u_map, u_mapView, v_map);
#endif
#endif
    vec3 key = u_lights[0].rgb * toKey.w * share;  // irradiance across the light's direction
    vec3 irradiance = key * cosKey;
    vec3 diffuse = base, radiance = u_emissive;
#if FULL
    vec3 F0 = mix(vec3(0.04), base, u_metallic), toEye = normalize(u_eye.xyz - u_eye.w * v_world);
    diffuse *= 1.0 - u_metallic;
    radiance += u_gloss * key * highlight(normal, toEye, toKey.xyz, u_roughness, F0);
    radiance += u_environment * F0 * u_metallic;
    for (int i = 1; i < u_lightCount; ++i) {
        vec4 to = towardsLight(u_lights[i], v_world);
        vec3 arriving = u_lights[i].rgb * to.w * coneFactor(u_lights[i], to.xyz);
        irradiance += arriving * max(dot(normal, to.xyz), 0.0);
        radiance += u_gloss * arriving * highlight(normal, toEye, to.xyz, u_roughness, F0);
    }
#endif
    // Brighter from above and from one side, so that corners read in the dark; its mean over directions is 1.
    vec3 ambient = u_environment * (1.0 + dot(normal, vec3(0.2, 0.35, 0.05)));
    radiance += diffuse * (irradiance + ambient);
    o_radiance = vec4(min(radiance, vec3(6e4)), 1.0);  // below the largest half float
}
