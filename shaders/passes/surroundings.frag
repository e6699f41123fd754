// One texel of an 8 x 8 summary of the picture: the mean of 8 x 8 samples of its cell. Highlights are bounded, so that a
// caustic's focus does not become a lamp in every reflection.
uniform sampler2D u_background;
layout(location = 0) out vec4 o_mean;

void main() {
    vec3 sum = vec3(0.0);
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) {
            vec2 uv = (floor(gl_FragCoord.xy) + (vec2(x, y) + 0.5) / 8.0) / 8.0;
            sum += min(textureLod(u_background, uv, 0.0).rgb, vec3(4.0));
        }
    }
    o_mean = vec4(sum / 64.0, 1.0);
}
