// L = albedo / pi * (E_key + E_others) + environment, in units of radianceUnit() (so pi is gone and lights come over the
// reference irradiance).   E_key = I cos / r^2 * (cone * cookie * visibility + concentration)
// RAYS: the points of neighbouring pixels have nothing to do with each other.
#include "common/lights.glsl"
#include "common/ggx.glsl"
#include "common/shadow.glsl"
#include "common/concentration.glsl"
uniform vec4 u_eye;                 // world; w 0: an orthographic camera's direction instead, towards the eye
uniform Light u_lights[8];          // [0] throws the shadow and the map
uniform vec3 u_environment;
#if SHADOW
uniform View u_shadowView;
uniform sampler2DShadow u_shadowDepth;
#endif
#if MAP
uniform View u_mapView;
uniform vec2 u_outerScale;
uniform sampler2D u_map, u_outerMap;
#endif
#if FULL
uniform int u_lightCount;
uniform bool u_hasCookie;
uniform View u_cookieView;
uniform sampler2D u_cookie;
#endif

struct Receiver {
    vec3 world, normal;             // normal: unit, of the side that is seen
    vec3 shadow, shadowNormal;      // in the shadow's view; the normal of any length
    vec3 map;                       // in the map's view
    vec3 base, emissive;
    float roughness, metallic;
    float gloss;                    // 0: Lambert alone
};

#if RAYS
float cone(Light light, vec3 toLight) { return coneFactor(light, toLight, 1e-3 * light.versineOuter); }
#else
float cone(Light light, vec3 toLight) { return coneFactor(light, toLight); }
#endif

vec3 shade(Receiver at) {
    // Key light: what reaches the point directly, and what casters send there.
    vec4 toKey = towardsLight(u_lights[0], at.world);
    float cosKey = max(dot(at.normal, toKey.xyz), 0.0);
    float direct = cone(u_lights[0], toKey.xyz);
#if SHADOW
    direct *= visibility(u_shadowDepth, u_shadowView, at.shadow, at.shadowNormal);
#endif
    vec3 share = vec3(direct);
#if FULL
    vec2 cookieUv = viewToUv(u_cookieView, (u_cookieView.worldToView * vec4(at.world, 1.0)).xyz);
    vec3 cookie = texture(u_cookie, vec2(cookieUv.x, 1.0 - cookieUv.y)).rgb;
    if (u_hasCookie) share *= cookie;
#endif
#if MAP == 2
    share += concentration(u_map, u_outerMap, u_mapView, u_outerScale, at.map);
#elif MAP
    share += concentration(u_map, u_mapView, at.map);
#endif
    vec3 key = u_lights[0].rgb * toKey.w * share;  // irradiance across the light's direction
    vec3 irradiance = key * cosKey;
    vec3 diffuse = at.base, radiance = at.emissive;
#if FULL
    vec3 F0 = mix(vec3(0.04), at.base, at.metallic), toEye = normalize(u_eye.xyz - u_eye.w * at.world);
    diffuse *= 1.0 - at.metallic;
    radiance += at.gloss * key * highlight(at.normal, toEye, toKey.xyz, at.roughness, F0);
    radiance += u_environment * F0 * at.metallic;
    for (int i = 1; i < u_lightCount; ++i) {
        vec4 to = towardsLight(u_lights[i], at.world);
        vec3 arriving = u_lights[i].rgb * to.w * cone(u_lights[i], to.xyz);
        irradiance += arriving * max(dot(at.normal, to.xyz), 0.0);
        radiance += at.gloss * arriving * highlight(at.normal, toEye, to.xyz, at.roughness, F0);
    }
#endif
    // Brighter from above and from one side, so that corners read in the dark; its mean over directions is 1.
    vec3 ambient = u_environment * (1.0 + dot(at.normal, vec3(0.2, 0.35, 0.05)));
    radiance += diffuse * (irradiance + ambient);
    return min(radiance, vec3(6e4));  // below the largest half float
}
