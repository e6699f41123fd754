// One program per mode (MODE: Present::Mode), with DOWNSAMPLE for an image of twice the size a side: each of the four
// pixels is brought to display range before they are averaged, so that bright edges stay smooth.
#include "common/tone.glsl"
#include "common/false_colour.glsl"
uniform sampler2D u_image;
uniform float u_scale;
uniform int u_height;      // of the output
uniform bool u_depthImage;
layout(location = 0) out vec4 o_color;

vec3 shown(ivec2 at) {
    vec4 value = texelFetch(u_image, at, 0);
#if MODE == 0
    return toneCurve(intoGamut(value.rgb * u_scale));
#elif MODE == 1
    return value.rgb * u_scale;
#elif MODE == 2
    return value.w > 0.0 ? clamp(0.5 + 0.5 * value.xyz, 0.0, 1.0) : vec3(0.0);
#elif MODE == 3
    return layerColour(u_depthImage ? value.r : value.w);
#elif MODE == 4
    return logColour(value.rgb * u_scale);
#else
    return heatColour(value.r * u_scale);
#endif
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.x, u_height - 1 - int(gl_FragCoord.y));
#if DOWNSAMPLE
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
