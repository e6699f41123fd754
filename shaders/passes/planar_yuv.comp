// Code values of RGB -> planes of Y, Cb and Cr, four bytes a word. Whole numbers, as libjpeg has them: conversion with 16
// fractional bits (jccolor.c), means of 2x2 that round down and up in turn along a row (jcsample.c). A thread writes whole
// words: 4 pixels of a row, or with HALF 8 of two rows.
layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2D u_image;   // rows top to bottom
uniform ivec2 u_size;        // pixels
uniform ivec2 u_stride;      // words a row: of Y, of Cb and Cr
uniform ivec2 u_offset;      // words before Cb, before Cr
layout(std430, binding = 0) writeonly buffer Planes { uint words[]; };

// Beyond the right and the lower edge the last pixel goes on.
ivec3 yuvAt(ivec2 at) {
    ivec3 c = ivec3(texelFetch(u_image, min(at, u_size - 1), 0).rgb * 255.0 + 0.5);
    return ivec3(19595 * c.r + 38470 * c.g + 7471 * c.b + 32768,
                 -11059 * c.r - 21709 * c.g + 32768 * c.b + 8421375,
                 32768 * c.r - 27439 * c.g - 5329 * c.b + 8421375) >> 16;
}

uint word(ivec4 bytes) { return uint(bytes.x | bytes.y << 8 | bytes.z << 16 | bytes.w << 24); }

void main() {
    ivec2 id = ivec2(gl_GlobalInvocationID.xy);
#if HALF
    ivec2 at = id * ivec2(8, 2);
    if (any(greaterThanEqual(at, u_size))) return;
    ivec4 cb, cr;
    for (int y = 0; y < 2; ++y) {
        ivec4 left, right;
        for (int x = 0; x < 4; ++x) {
            ivec3 a = yuvAt(at + ivec2(2 * x, y)), b = yuvAt(at + ivec2(2 * x + 1, y));
            if (x < 2) left[2 * x] = a.x, left[2 * x + 1] = b.x;
            else right[2 * x - 4] = a.x, right[2 * x - 3] = b.x;
            cb[x] = (y == 0 ? 1 + (x & 1) : cb[x]) + a.y + b.y;
            cr[x] = (y == 0 ? 1 + (x & 1) : cr[x]) + a.z + b.z;
        }
        int row = (at.y + y) * u_stride.x + 2 * id.x;
        words[row] = word(left);
        if (2 * id.x + 1 < u_stride.x) words[row + 1] = word(right);
    }
    int place = id.y * u_stride.y + id.x;
    words[u_offset.x + place] = word(cb >> 2);
    words[u_offset.y + place] = word(cr >> 2);
#else
    ivec2 at = id * ivec2(4, 1);
    if (any(greaterThanEqual(at, u_size))) return;
    ivec4 luma, cb, cr;
    for (int x = 0; x < 4; ++x) {
        ivec3 yuv = yuvAt(at + ivec2(x, 0));
        luma[x] = yuv.x, cb[x] = yuv.y, cr[x] = yuv.z;
    }
    int place = id.y * u_stride.x + id.x;
    words[place] = word(luma);
    words[u_offset.x + place] = word(cb);
    words[u_offset.y + place] = word(cr);
#endif
}
