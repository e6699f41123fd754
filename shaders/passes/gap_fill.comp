// One thread sweeps one row (COLUMNS 0) or column (1) with two running sums: what lies within kSteps before a texel and
// what lies within kSteps after it. The constants are the thesis's (Blanchette 2012, appendix A, gap-filling shader).
#include "shared/layout.h"

layout(local_size_x = kGroupSize) in;
layout(rgba32f, binding = 0) uniform writeonly image2D u_out;
uniform sampler2D u_map;
uniform sampler2D u_rows;             // COLUMNS: what the rows gave

const int kSteps = 20;                // looks at the kSteps - 1 texels on either side
const float kBrightness = 0.2;
const float kLit = 0.1;               // a side counts when a channel's sum is above this
const float kDark = 0.3;              // a texel is filled when all channels are below this

ivec2 texelAt(int line, int i) {
#if COLUMNS
    return ivec2(line, i);
#else
    return ivec2(i, line);
#endif
}

vec3 mapAt(int line, int i, int size) {
    return i < 0 || i >= size ? vec3(0.0) : texelFetch(u_map, texelAt(line, i), 0).rgb;
}

void main() {
    int size = textureSize(u_map, 0).x;
    int line = int(gl_GlobalInvocationID.x);
    if (line >= size) return;
    vec3 before = vec3(0.0);
    vec3 after = vec3(0.0);
    for (int i = 1; i < kSteps; ++i) after += mapAt(line, i, size);
    for (int i = 0; i < size; ++i) {
        vec3 fill = vec3(0.0);
        if (any(greaterThan(before, vec3(kLit))) && any(greaterThan(after, vec3(kLit)))) {
            fill = mix(before, after, 0.5) * kBrightness;
        }
        vec3 here = mapAt(line, i, size);
#if COLUMNS
        vec3 shown = here;
        if (all(lessThan(here, vec3(kDark)))) shown = mix(fill, texelFetch(u_rows, texelAt(line, i), 0).rgb, 0.5);
        imageStore(u_out, texelAt(line, i), vec4(shown, texelFetch(u_map, texelAt(line, i), 0).a));
#else
        imageStore(u_out, texelAt(line, i), vec4(fill, 1.0));
#endif
        before = max(before + here - mapAt(line, i - kSteps + 1, size), 0.0);
        after = max(after + mapAt(line, i + kSteps, size) - mapAt(line, i + 1, size), 0.0);
    }
}
