// Adds a picture to the weighted mean of those before it.
layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2D u_sample;
uniform float u_share;       // of the new picture in the mean
layout(rgba32f, binding = 0) uniform image2D u_mean;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(u_mean)))) return;
    vec4 now = texelFetch(u_sample, at, 0);
    vec4 mean = u_share < 1.0 ? imageLoad(u_mean, at) : now;   // there may be no mean yet
    imageStore(u_mean, at, mean + u_share * (now - mean));
}
