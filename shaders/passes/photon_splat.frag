// The splat of one photon and wavelength, added to the map: Blanchette 2012, appendix A (the Gaussian is that of Graphics
// Gems I, "Convenient anti-aliasing filters that minimize bumpy sampling").
flat in vec4 g_splat;
flat in vec2 g_centre;
layout(location = 0) out vec4 o_concentration;

void main() {
    const float kSizeSqr = 2.5 * 2.5;      // pixels
    const float kAlpha = 0.918, kBetaX2 = 3.906, kDenom = 0.858152111;
    const float kNormalize = 10.5 * kSizeSqr / 25.0;
    vec2 offset = gl_FragCoord.xy - g_centre;
    float part = dot(offset, offset) / kSizeSqr;
    float intensity = kAlpha + kAlpha * ((exp(-kBetaX2 * part) - 1.0) / kDenom);
    o_concentration = g_splat * (part < 0.25 ? intensity / kNormalize : 0.0);
}
