// The receivers with the printed gains (Blanchette 2012, appendix A, the two shaders that project shadow and spectral
// map): no distance in the light, a shadow that takes a quarter of it, a caustic three times as bright. What is printed as
// a display value is taken as radiance over radianceUnit() here, so that exposure means the same in every mode.
#include "common/lights.glsl"
#include "common/shadow.glsl"
#include "common/concentration.glsl"
in vec3 v_world, v_normal;
uniform Light u_lights[8];          // [0], the key light, is the only one
uniform vec3 u_keyColour;
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
uniform bool u_hasCookie;
uniform View u_cookieView;
uniform sampler2D u_cookie;
#endif
layout(location = 0) out vec4 o_radiance;

void main() {
    vec3 normal = normalize((gl_FrontFacing ? v_normal : -v_normal) + 1e-20);
    vec3 toKey = towardsLight(u_lights[0], v_world).xyz;
    float NdotL = max(dot(normal, toKey), 0.0);
    vec3 color = min(1.0, 1.0 / 1.5 + NdotL / 3.0) * u_baseColor;

    // The spotlight's texture: cone, cookie and colour.
    vec3 spot = u_keyColour * coneFactor(u_lights[0], toKey);
#if FULL
    vec2 cookieUv = viewToUv(u_cookieView, (u_cookieView.worldToView * vec4(v_world, 1.0)).xyz);
    if (u_hasCookie) spot *= texture(u_cookie, vec2(cookieUv.x, 1.0 - cookieUv.y)).rgb;
#endif
    float shade = 1.0;
#if SHADOW
    shade = 0.25 * visibility(u_shadowDepth, u_shadowView, v_shadow, cross(dFdx(v_shadow), dFdy(v_shadow))) + 0.75;
#endif
    vec3 radiance = shade * color * spot * 0.7 + color * u_environment;
#if MAP
    radiance += 3.0 * NdotL * u_keyColour * concentration(u_map, u_outerMap, u_mapView, u_outerScale, v_map);
#endif
#if TEXTURE
    radiance *= texture(u_baseColorTexture, v_uv).rgb;
#endif
    o_radiance = vec4(min(radiance + u_emissive, vec3(6e4)), 1.0);   // below the largest half float
}
