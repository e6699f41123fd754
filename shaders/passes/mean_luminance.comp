// The luminance of a picture after the tone curve, as displays show it, summed column by column.
#include "common/tone.glsl"
layout(local_size_x = 32) in;
uniform sampler2D u_image;
uniform float u_scale;
layout(std430, binding = 0) writeonly buffer Sums { float sums[]; };   // one a column

void main() {
    int x = int(gl_GlobalInvocationID.x);
    ivec2 size = textureSize(u_image, 0);
    if (x >= size.x) return;
    float sum = 0.0;
    for (int y = 0; y < size.y; ++y) {
        sum += luminance(toneCurve(intoGamut(texelFetch(u_image, ivec2(x, y), 0).rgb * u_scale)));
    }
    sums[x] = sum;
}
