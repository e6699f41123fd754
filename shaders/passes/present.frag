// One program per mode (MODE: Present::Mode); with FADE a picture takes the place of another, with RESIZED of one of another
// size; with DOWNSAMPLE for an image of twice the size a side: each of the four pixels is brought to display range before they
// are averaged, so that bright edges stay smooth.
#include "common/tone.glsl"
#include "common/false_colour.glsl"
uniform sampler2D u_image;
uniform float u_scale;
uniform ivec2 u_size;      // of the output
uniform bool u_depthImage;
#if FADE
uniform sampler2D u_before;
uniform float u_share;     // of u_image
#endif
layout(location = 0) out vec4 o_color;

vec3 shown(ivec2 at) {
    vec4 value = texelFetch(u_image, at, 0);
#if MODE == 0 && FADE
#if RESIZED
    vec3 light = textureLod(u_before, (vec2(at) + 0.5) / vec2(textureSize(u_image, 0)), 0.0).rgb;
#else
    vec3 light = texelFetch(u_before, at, 0).rgb;
#endif
    vec3 before = toneCurve(intoGamut(light * u_scale));
    return mix(before, toneCurve(intoGamut(value.rgb * u_scale)), u_share);
#elif MODE == 0
    return toneCurve(intoGamut(value.rgb * u_scale));
#elif MODE == 1
    return value.rgb * u_scale;
#elif MODE == 2
    return value.w > 0.0 ? clamp(0.5 + 0.5 * value.xyz, 0.0, 1.0) : vec3(0.0);
#elif MODE == 3
    return layerColour(u_depthImage ? value.r : value.w);
#elif MODE == 4
    return logColour(value.rgb * u_scale);
#elif MODE == 5
    return distanceColour(value.w, u_scale);
#else
    return labelColour(value.r);
#endif
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.x, u_size.y - 1 - int(gl_FragCoord.y));
#if MODE >= 2
    // A pass's image has a size of its own: shown whole, in the middle.
    vec2 size = vec2(textureSize(u_image, 0));
    vec2 zoom = vec2(u_size) / size;
    vec2 place = (vec2(at) + 0.5 - 0.5 * vec2(u_size)) / min(zoom.x, zoom.y) + 0.5 * size;
    at = ivec2(floor(place));
    if (any(lessThan(place, vec2(0.0))) || any(greaterThanEqual(place, size))) {
        o_color = vec4(vec3(0.1), 1.0);
        return;
    }
#endif
#if DOWNSAMPLE && MODE < 2
    vec3 color = 0.25 * (shown(2 * at) + shown(2 * at + ivec2(1, 0)) + shown(2 * at + ivec2(0, 1)) +
                         shown(2 * at + ivec2(1, 1)));
#else
    vec3 color = shown(at);
#endif
#if MODE == 0
    color = encodeSrgb(color);
#endif
    o_color = vec4(color, 1.0);
}
