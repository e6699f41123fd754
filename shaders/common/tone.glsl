// From linear BT.709 of any brightness to what a display shows.

float luminance(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722)); }

// A colour no display has (a negative channel) moves towards the grey of its own luminance, just far enough.
vec3 intoGamut(vec3 rgb) {
    float grey = max(luminance(rgb), 0.0), lowest = min(rgb.r, min(rgb.g, rgb.b));
    return lowest < 0.0 ? max(mix(vec3(grey), rgb, grey / max(grey - lowest, 1e-20)), vec3(0.0)) : rgb;
}

// Khronos 2024, PBR Neutral Tone Mapper, without its offset for the base reflectance: exact up to kStart, then the
// largest channel approaches 1, the hue is kept and very bright colours pale. Grey stays grey.
vec3 toneCurve(vec3 rgb) {
    const float kStart = 0.76, kPaling = 0.15;
    float peak = max(rgb.r, max(rgb.g, rgb.b)), room = 1.0 - kStart;
    float squeezed = 1.0 - room * room / (max(peak, kStart) + room - kStart);
    float paling = 1.0 - 1.0 / (kPaling * (peak - squeezed) + 1.0);
    return peak <= kStart ? rgb : mix(rgb * (squeezed / peak), vec3(squeezed), paling);
}

// IEC 61966-2-1.
vec3 encodeSrgb(vec3 linear) {
    vec3 x = clamp(linear, 0.0, 1.0);
    return mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, greaterThan(x, vec3(0.0031308)));
}
