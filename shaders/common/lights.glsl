// A light as receivers see it: irradiance before shadow and map.
#include "common/view.glsl"

struct Light {
    vec3 position;      // world, m; unused when directional
    vec3 direction;     // unit, the way the light travels
    vec3 rgb;           // candela (or lux) times colour, over the reference irradiance
    float versineOuter; // 1 - cosine of the outer half angle; above 2: no cone
    float coneScale;    // 1 / (outer - inner versine); 0: a hard edge
    bool directional;
};

// Unit vector from `posWorld` towards the light, and 1 / r^2 (1 when directional) in w.
vec4 towardsLight(Light light, vec3 posWorld) {
    if (light.directional) return vec4(-light.direction, 1.0);
    vec3 to = light.position - posWorld;
    float r2 = max(dot(to, to), 1e-20);
    return vec4(to * inversesqrt(r2), 1.0 / r2);
}

// KHR_lights_punctual: squared ramp in the cosine between inner and outer cone. A hard edge is as wide as `pixel`.
float coneFactor(Light light, vec3 toLight, float pixel) {
    vec3 off = light.direction + toLight;
    float c = light.versineOuter - 0.5 * dot(off, off);   // as emission.glsl does it, and why
    float soft = clamp(c * light.coneScale, 0.0, 1.0);
    return light.coneScale > 0.0 ? soft * soft : clamp(c / pixel + 0.5, 0.0, 1.0);
}

// One pixel wide.
float coneFactor(Light light, vec3 toLight) {
    vec3 off = light.direction + toLight;
    return coneFactor(light, toLight, max(fwidth(light.versineOuter - 0.5 * dot(off, off)), 1e-12));
}
