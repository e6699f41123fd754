// Traces each listed photon at its wavelengths through two interfaces to the receivers and deposits its flux in the
// spectral map. The longest wavelength, which is bent least, searches its way from nothing; the others start where it
// ended. Those that do not
// settle there go to a second dispatch (RETRY 1) that searches each from nothing, as a branch costs every photon the
// time of those that take it.
#include "shared/layout.h"
#include "common/view.glsl"
#include "common/emission.glsl"
#include "common/optics.glsl"
#include "common/layer.glsl"
#include "common/residuals.glsl"
#include "common/exit_point.glsl"
#include "common/receiver.glsl"

layout(local_size_x = kGroupSize) in;
layout(std430, binding = kBindList) readonly buffer List {
    uint groups[3];
    uint count;
    uint texels[];
};
layout(std430, binding = kBindMap) buffer Map { uint map[]; };          // texel-major; inner map's levels, then the outer
layout(std430, binding = kBindLedger) buffer Ledger { uint ledger[]; };
layout(std430, binding = kBindRetry) buffer Retry {
    uint retryGroups[3];
    uint retryCount;
    uvec4 retries[];             // texel, level of the pyramid (float bits), wavelengths still to trace (64 bits)
};

uniform sampler2D u_front;           // emission view
uniform sampler2D u_back;            // back view
uniform sampler2D u_receivers;       // map view
uniform sampler2D u_outerReceivers;  // outer view
uniform View u_emission, u_backView, u_mapView, u_outerView;
uniform mat4 u_emissionToBack, u_backToMap;   // rigid; the outer view shares the map view's space

uniform int u_wavelengths;
uniform int u_bands;                           // BANDS: bands of the map
uniform vec4 u_glass[kMostWavelengths];        // n outside / n inside, absorption (1/m), luminance weight, band
uniform vec4 u_xyz[kMostWavelengths];          // weight of each wavelength
uniform float u_fixedPerFlux;                  // fixed-point units per unit of flux
uniform float u_ledgerPerFlux;
uniform int u_levels;                          // of the inner map's pyramid, 1..kMostLevels
uniform int u_backSteps, u_receiverSteps;
uniform float u_exitTolerance;                 // m
uniform float u_reach;                         // m: farther than any receiver
#include "common/deposit.glsl"

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

// What became of a photon's flux, as rows of the ledger.
struct Tally {
    float absorbed, reflected, total;
};

// From entry to the outside: what is left of `flux`, and the ray in the map view's space. `way` starts as a guess.
const int kLeaves = 0, kTotal = 1, kUnsettled = 2;
int passThrough(Entry entry, int k, int steps, inout float way, out vec3 exitNormal, out vec3 origin, out vec3 ray,
                inout float flux, out Tally tally) {
    float eta = u_glass[k].x;
    vec3 inside, outside;
    float reflectance;
    tally = Tally(0.0, 0.0, 0.0);
    exitNormal = origin = ray = vec3(0.0);
    bool enters = refractDielectric(entry.direction, entry.normal, eta, inside, reflectance);
    if (!enters) {
        tally.total = flux;
        return kTotal;
    }
    tally.reflected = flux * reflectance;
    flux *= 1.0 - reflectance;
    if (!findExit(u_backView, u_back, entry.position, inside, steps, u_exitTolerance, way, exitNormal)) return kUnsettled;
    tally.absorbed = flux * (1.0 - exp(-u_glass[k].y * way));
    flux -= tally.absorbed;
    if (!refractDielectric(inside, -exitNormal, 1.0 / eta, outside, reflectance)) {
        tally.total = flux;
        return kTotal;
    }
    tally.reflected += flux * reflectance;
    flux *= 1.0 - reflectance;
    origin = (u_backToMap * vec4(entry.position + way * inside, 1.0)).xyz;
    ray = mat3(u_backToMap) * outside;
    return kLeaves;
}

void book(int row, float flux) {
    uint bank = (gl_WorkGroupID.x % uint(kLedgerBanks)) * uint(kLedgerRows);
    if (flux > 0.0) atomicAdd(ledger[bank + uint(row)], uint(flux * u_ledgerPerFlux + 0.5));
}

#if RETRY
void main() {
    uint item = gl_GlobalInvocationID.x;
    if (item >= retryCount) return;
    uvec4 retry = retries[item];
    ivec2 size = textureSize(u_front, 0);
    ivec2 texel = ivec2(retry.x % uint(size.x), retry.x / uint(size.x));
    photonHalf = halfOf(texel);
    Entry entry = entryAt(texel);
    float guess = guessWay(entry);
    ivec2 innerSize = textureSize(u_receivers, 0);
    ivec2 outerSize = textureSize(u_outerReceivers, 0);
    int outerFirst = firstTexelOf(u_levels, innerSize);
    Level level = levelOf(uintBitsToFloat(retry.y), innerSize);

    float absorbed = 0.0, reflected = 0.0, total = 0.0, rejected = 0.0, left = 0.0, missed = 0.0;
    uvec2 remaining = retry.zw;
    while ((remaining.x | remaining.y) != 0u) {
        int k = remaining.x != 0u ? findLSB(remaining.x) : 32 + findLSB(remaining.y);
        if (k < 32) remaining.x &= remaining.x - 1u;
        else remaining.y &= remaining.y - 1u;

        float weight = u_glass[k].z, flux = entry.flux, way = guess;
        vec3 exitNormal, origin, ray;
        Tally tally;
        int passed = passThrough(entry, k, u_backSteps, way, exitNormal, origin, ray, flux, tally);
        absorbed += weight * tally.absorbed;
        reflected += weight * tally.reflected;
        total += weight * tally.total;
        if (passed == kUnsettled) rejected += weight * flux;
        if (passed != kLeaves) continue;

        vec2 at;
        Meeting met;
        int found = findReceiver(u_mapView, u_receivers, origin, ray, u_reach, u_receiverSteps, at, met);
        Place fine = placeAt(at, level.fineSize, level.fineFirst);
        float coarseShare = level.coarseShare;
        Place coarse = placeAt(at, level.coarseSize, level.coarseFirst);
        if (found == kLeftView || found == kNoReceiver) {
            found = findReceiver(u_outerView, u_outerReceivers, origin, ray, u_reach, u_receiverSteps, at, met);
            fine = placeAt(at, outerSize, outerFirst);
            coarseShare = 0.0;
        }
        if (found == kHit) {
            deposit(fine, k, flux * (1.0 - coarseShare));
            if (coarseShare > 0.0) deposit(coarse, k, flux * coarseShare);
        }
        rejected += found == kRejected ? weight * flux : 0.0;
        left += found == kLeftView ? weight * flux : 0.0;
        missed += found == kNoReceiver ? weight * flux : 0.0;
    }
    book(kLedgerAbsorbed, absorbed);
    book(kLedgerReflected, reflected);
    book(kLedgerTotalReflection, total);
    book(kLedgerRejected, rejected);
    book(kLedgerLeftMap, left);
    book(kLedgerNoReceiver, missed);
}
#else

// Where the photon of a neighbouring texel lands in the inner map at the longest wavelength; false when it takes another
// way: another facet, a step in depth, another receiver.
bool neighbourLanding(ivec2 texel, float way, vec3 ownExitNormal, Meeting meeting, out vec2 at) {
    vec3 exitNormal, origin, ray;
    Tally tally;
    Entry entry = entryAt(texel);
    float flux = entry.flux;
    at = vec2(0.0);
    return passThrough(entry, u_wavelengths - 1, kFollowSteps, way, exitNormal, origin, ray, flux, tally) == kLeaves &&
           dot(exitNormal, ownExitNormal) > kSameSurfaceCos &&
           followReceiver(u_mapView, u_receivers, origin, ray, meeting, at);
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
    float top = float(u_levels - 1);
    // No neighbour goes its way: at the rim, where light spreads most.
    return apart < 0.0 ? top : clamp(log2(max(apart, 1e-3)) + kLevelBias, 0.0, top);
}

void main() {
    uint photon = gl_GlobalInvocationID.x;
    if (photon >= count) return;
    ivec2 size = textureSize(u_front, 0);
    uint index = texels[photon];
    ivec2 texel = ivec2(index % uint(size.x), index / uint(size.x));
    photonHalf = halfOf(texel);
    Entry entry = entryAt(texel);

    // The longest wavelength's way, and how far its neighbours land
    float way = guessWay(entry), level = float(u_levels - 1), flux = entry.flux;
    vec3 exitNormal, origin, ray;
    vec2 at;
    Tally tally;
    Meeting meeting = Meeting(0.0, 0.0);
    int passed = passThrough(entry, u_wavelengths - 1, u_backSteps, way, exitNormal, origin, ray, flux, tally);
    bool allReflected = passed == kTotal, met = false;
    if (passed == kLeaves) {
        met = findReceiver(u_mapView, u_receivers, origin, ray, u_reach, u_receiverSteps, at, meeting) == kHit;
        if (!met) meeting.slope = 0.0;
        if (u_levels > 1 && met) level = levelAt(texel, entry.layer, way, exitNormal, meeting, at);
    }
    Level pyramid = levelOf(level, textureSize(u_receivers, 0));

    // All wavelengths from there: where each lands, and with how much. Its way is guessed from the two before it.
    vec3 landed[kMostWavelengths];           // uv in the inner map, flux; no flux: nowhere
    float onCasters = 0.0, absorbed = 0.0, reflected = 0.0, total = 0.0, lastWay = way;
    uvec2 unsettled = uvec2(0u);
    int k = u_wavelengths - 1;
    while (true) {
        float weight = u_glass[k].z;
        onCasters += weight * entry.flux;
        landed[k] = vec3(at, met ? flux : 0.0);
        // One step may reflect a ray that would leave: it is searched again, unless the longest is reflected as well.
        if (met || (passed == kTotal && allReflected)) {
            absorbed += weight * tally.absorbed;
            reflected += weight * tally.reflected;
            total += weight * tally.total;
        } else if (k < 32) {
            unsettled.x |= 1u << k;
        } else {
            unsettled.y |= 1u << (k - 32);
        }
        if (--k < 0) break;
        // Glass that does not differ has no other way: white stays white at the rim too, where steps hardly settle.
        if (u_glass[k].xy != u_glass[k + 1].xy) {
            float guess = way + (way - lastWay);
            lastWay = way;
            way = guess;
            flux = entry.flux;
            passed = passThrough(entry, k, kFollowSteps, way, exitNormal, origin, ray, flux, tally);
            met = passed == kLeaves && followReceiver(u_mapView, u_receivers, origin, ray, meeting, at);
        }
    }
    depositAll(landed, pyramid.fineSize, pyramid.fineFirst, 1.0 - pyramid.coarseShare);
    depositAll(landed, pyramid.coarseSize, pyramid.coarseFirst, pyramid.coarseShare);
    if ((unsettled.x | unsettled.y) != 0u) {
        uint place = atomicAdd(retryCount, 1u);
        atomicMax(retryGroups[0], place / uint(kGroupSize) + 1u);
        retries[place] = uvec4(index, floatBitsToUint(level), unsettled);
    }
    book(kLedgerOnCasters, onCasters);
    book(kLedgerAbsorbed, absorbed);
    book(kLedgerReflected, reflected);
    book(kLedgerTotalReflection, total);
}
#endif
