// A photon of photon_trace, from its texel of the emission view through the caster; and how far its neighbours land.
// Expects the uniforms of photon_trace.
const float kLevelBias = 0.6;   // photons a texel apart show their lattice in texels of just that width
const int kFollowSteps = 1;     // Newton steps from where the neighbouring wavelengths' ways point to

// A photon where it meets the caster, in the back view's space.
struct Entry {
    vec4 layer;        // of the front layer, emission view
    vec3 position, normal, direction;
    float flux;
};

Entry entryAt(ivec2 texel) {
    vec2 size = vec2(textureSize(u_front, 0));
    vec2 uv = (vec2(texel) + 0.5) / size;
    vec4 layer = texelFetch(u_front, clamp(texel, ivec2(0), ivec2(size) - 1), 0);
    vec3 direction = viewDirection(u_emission, uv);
    mat3 turn = mat3(u_emissionToBack);
    return Entry(layer, (u_emissionToBack * vec4(layerToView(u_emission, uv, layer.w), 1.0)).xyz, turn * layer.xyz,
                 turn * direction, emittedShare(direction) * texelExtent(u_emission, uv, 1.0 / size));
}

// First guess of the way inside: along the light's own ray.
float guessWay(Entry entry) {
    vec2 uv = viewToUv(u_backView, entry.position);
    vec4 behind;
    if (!sampleLayer(u_back, uv, behind)) return 5.0 * u_exitTolerance;
    return max(distance(layerToView(u_backView, uv, behind.w), entry.position), 0.01 * u_exitTolerance);
}

// From entry to the outside at a relative index `eta`, by the back layer: `way` inside starts as a guess; the ray is in
// the map view's space; `reflectance` at the first and the second interface, 1 where the light is reflected totally.
const int kLeaves = 0, kTotal = 1, kUnsettled = 2;
int passThrough(Entry entry, float eta, int steps, inout float way, out vec3 exitNormal, out vec3 origin, out vec3 ray,
                out vec2 reflectance) {
    vec3 inside, outside;
    reflectance = vec2(0.0);
    exitNormal = origin = ray = vec3(0.0);
    if (!refractDielectric(entry.direction, entry.normal, eta, inside, reflectance.x)) return kTotal;
    // Of a sphere's chord; a normal between those of a crease may face away from the ray.
    float chord = way * abs(dot(inside, entry.normal)) / max(abs(dot(entry.direction, entry.normal)), 1e-4);
    float deeper = min(chord, 20.0 * u_exitTolerance);
    if (!findExit(u_backView, u_back, entry.position, inside, steps, u_exitTolerance, deeper, way, exitNormal)) return kUnsettled;
    if (!refractDielectric(inside, -exitNormal, 1.0 / eta, outside, reflectance.y)) return kTotal;
    origin = (u_backToMap * vec4(entry.position + way * inside, 1.0)).xyz;
    ray = mat3(u_backToMap) * outside;
    return kLeaves;
}

// What became of a photon's flux, as rows of the ledger.
struct Tally {
    float absorbed, reflected, total;
};

// What leaves of `flux` after `way` in a medium that absorbs; the rest is added to the tally, times `weight`.
float share(float flux, float weight, int passed, vec2 reflectance, float absorption, float way, inout Tally tally) {
    float inside = flux * (1.0 - reflectance.x);
    float through = inside;
#if ABSORPTION
    through *= passed == kUnsettled ? 1.0 : exp(-absorption * way);
    tally.absorbed += weight * (inside - through);
#endif
    tally.reflected += weight * (flux * (reflectance.x < 1.0 ? reflectance.x : 0.0) + through * (reflectance.y < 1.0 ? reflectance.y : 0.0));
    tally.total += weight * (flux * (reflectance.x < 1.0 ? 0.0 : 1.0) + through * (reflectance.y < 1.0 ? 0.0 : 1.0));
    return through * (1.0 - reflectance.y);
}

// What is added before rounding down, in 0..1: alike photons would all be rounded the same way, and four million of them
// add up to 1e-3 of the flux. The golden ratio's multiples spread evenly; a texel has its own, so that bits repeat.
float g_rounding = 0.5;
void roundBy(uint texel) { g_rounding = float((texel * 2654435769u) >> 8) / 16777216.0; }

void book(int row, float flux) {
    uint bank = (gl_WorkGroupID.x % uint(kLedgerBanks)) * uint(kLedgerRows);
    if (flux > 0.0) atomicAdd(ledger[bank + uint(row)], uint(flux * u_ledgerPerFlux + g_rounding));
}

void book(Tally tally) {
#if ABSORPTION
    book(kLedgerAbsorbed, tally.absorbed);
#endif
    book(kLedgerReflected, tally.reflected);
    book(kLedgerTotalReflection, tally.total);
}

// Where the photon of a neighbouring texel lands in the inner map at the longest wavelength; false when it takes another
// way: another facet, a step in depth, another receiver.
bool neighbourLanding(ivec2 texel, float way, vec3 ownExitNormal, Meeting meeting, out vec2 at) {
    vec3 exitNormal, origin, ray;
    vec2 reflectance;
    at = vec2(0.0);
    return passThrough(entryAt(texel), u_glass[u_wavelengths - 1].x, kFollowSteps, way, exitNormal, origin, ray, reflectance) == kLeaves &&
           dot(exitNormal, ownExitNormal) > kSameSurfaceCos &&
           followReceiver(u_mapView, u_receivers, origin, ray, false, meeting, at);
}

bool sameSurface(vec4 layer, vec4 own) {
    return dot(layer.xyz, own.xyz) > kSameSurfaceCos && abs(layer.w - own.w) < 0.05 * own.w;
}

// Level of the pyramid whose texels are as wide as the photons lie apart around `at`, so that they neither leave holes
// nor blur what they resolve.
float levelAt(ivec2 texel, vec4 own, float way, vec3 exitNormal, Meeting meeting, vec2 at) {
    vec2 mapSize = vec2(textureSize(u_receivers, 0));
    ivec2 most = textureSize(u_front, 0) - 1;
    float apart = -1.0;
    for (int axis = 0; axis < 2; ++axis) {
        ivec2 offset = axis == 0 ? ivec2(1, 0) : ivec2(0, 1);
        ivec2 ahead = min(texel + offset, most), behind = max(texel - offset, ivec2(0));
        bool forwards = sameSurface(texelFetch(u_front, ahead, 0), own) && ahead != texel;
        vec2 other;
        if ((forwards || sameSurface(texelFetch(u_front, behind, 0), own)) &&
            neighbourLanding(forwards ? ahead : behind, way, exitNormal, meeting, other)) {
            apart = max(apart, length((other - at) * mapSize));
        }
    }
    if (apart >= 0.0) photonWidth = clamp(kOverlap * apart, kNarrowest, 1.0);
    float top = float(u_levels - 1);
    // No neighbour goes its way: at the rim, where light spreads most.
    return apart < 0.0 ? top : clamp(log2(max(apart, 1e-3)) + kLevelBias, 0.0, top);
}
