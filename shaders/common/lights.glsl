// A light as receivers see it: irradiance before shadow and map.
#include "common/view.glsl"

struct Light {
    vec3 position;      // world, m; unused when directional
    vec3 direction;     // unit, the way the light travels
    vec3 rgb;           // candela (or lux) times colour, over the reference irradiance
    float cosOuter;     // below -1: no cone
    float coneScale;    // 1 / (cos inner - cos outer); 0: a hard edge
    bool directional;
};

// Unit vector from `posWorld` towards the light, and 1 / r^2 (1 when directional) in w.
vec4 towardsLight(Light light, vec3 posWorld) {
    if (light.directional) return vec4(-light.direction, 1.0);
    vec3 to = light.position - posWorld;
    float r2 = max(dot(to, to), 1e-20);
    return vec4(to * inversesqrt(r2), 1.0 / r2);
}

// KHR_lights_punctual: squared ramp in the cosine between inner and outer cone. A hard edge is one pixel wide.
float coneFactor(Light light, vec3 toLight) {
    float c = -dot(light.direction, toLight) - light.cosOuter;
    float pixel = max(fwidth(c), 1e-7);
    float soft = clamp(c * light.coneScale, 0.0, 1.0);
    return light.coneScale > 0.0 ? soft * soft : clamp(c / pixel + 0.5, 0.0, 1.0);
}
