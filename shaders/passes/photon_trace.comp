// Traces each listed photon at its wavelengths through two interfaces to the receivers and deposits its flux in the
// spectral map. The longest wavelength, which is bent least, searches its way from nothing; the others start where it
// ended. Those that do not
// settle there go to further dispatches (RETRY 1) that search each from nothing, as a branch costs every photon the
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
    uint retryHeads[2 * kListHeader];   // of two lists: the dispatch size (3), how many
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

#include "common/photon.glsl"

#if RETRY
uniform int u_retryList;

uint retriesListed() { return retryHeads[u_retryList * kListHeader + 3]; }
uvec4 retryAt(uint item) { return retries[u_retryList == 0 ? item : uint(retries.length()) - 1u - item]; }
#else
// Photons with little left to trace are listed from the front, those with all of it from the end: a processor takes eight
// at a time and is done when the longest of them is.
void traceAgain(uvec4 item, bool all) {
    uint head = all ? uint(kListHeader) : 0u;
    uint place = atomicAdd(retryHeads[head + 3u], 1u);
    atomicMax(retryHeads[head], place / uint(kGroupSize) + 1u);
    retries[all ? uint(retries.length()) - 1u - place : place] = item;
}
#endif

#if CONTINUOUS && !BANDS    // bands are exact wavelengths
#include "common/continuous.glsl"
#elif RETRY
void main() {
    uint item = gl_GlobalInvocationID.x;
    if (item >= retriesListed()) return;
    uvec4 retry = retryAt(item);
    roundBy(retry.x);
    ivec2 size = textureSize(u_front, 0);
    ivec2 texel = ivec2(retry.x % uint(size.x), retry.x / uint(size.x));
    photonHalf = halfOf(texel);
    Entry entry = entryAt(texel);
    float guess = guessWay(entry);
    ivec2 innerSize = textureSize(u_receivers, 0);
    ivec2 outerSize = textureSize(u_outerReceivers, 0);
    int outerFirst = firstTexelOf(u_levels, innerSize);
    Level level = levelOf(uintBitsToFloat(retry.y), innerSize);

    Tally tally = Tally(0.0, 0.0, 0.0);
    float rejected = 0.0, left = 0.0, missed = 0.0;
    uvec2 remaining = retry.zw;
    while ((remaining.x | remaining.y) != 0u) {
        int k = remaining.x != 0u ? findLSB(remaining.x) : 32 + findLSB(remaining.y);
        if (k < 32) remaining.x &= remaining.x - 1u;
        else remaining.y &= remaining.y - 1u;

        float weight = u_glass[k].z, way = guess;
        vec3 exitNormal, origin, ray;
        vec2 reflectance;
        int passed = passThrough(entry, u_glass[k].x, u_backSteps, way, exitNormal, origin, ray, reflectance);
        float flux = share(entry.flux, weight, passed, reflectance, u_glass[k].y, way, tally);
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
    book(tally);
    book(kLedgerRejected, rejected);
    book(kLedgerLeftMap, left);
    book(kLedgerNoReceiver, missed);
}
#else
void main() {
    uint photon = gl_GlobalInvocationID.x;
    if (photon >= count) return;
    ivec2 size = textureSize(u_front, 0);
    uint index = texels[photon];
    roundBy(index);
    ivec2 texel = ivec2(index % uint(size.x), index / uint(size.x));
    photonHalf = halfOf(texel);
    Entry entry = entryAt(texel);

    // The longest wavelength's way, and how far its neighbours land
    float way = guessWay(entry), level = float(u_levels - 1);
    vec3 exitNormal, origin, ray;
    vec2 at, reflectance;
    Meeting meeting = Meeting(0.0, 0.0);
    int passed = passThrough(entry, u_glass[u_wavelengths - 1].x, u_backSteps, way, exitNormal, origin, ray, reflectance);
    bool allReflected = passed == kTotal, met = false;
    if (passed == kLeaves) {
        met = findReceiver(u_mapView, u_receivers, origin, ray, u_reach, u_receiverSteps, at, meeting) == kHit;
        if (!met) meeting.slope = 0.0;
        if (u_levels > 1 && met) level = levelAt(texel, entry.layer, way, exitNormal, meeting, at);
    }
    Level pyramid = levelOf(level, textureSize(u_receivers, 0));

    // All wavelengths from there: where each lands, and with how much. Its way is guessed from the two before it.
    vec3 landed[kMostWavelengths];           // uv in the inner map, flux; no flux: nowhere
    Tally tally = Tally(0.0, 0.0, 0.0);
    float onCasters = 0.0, lastWay = way;
    uvec2 unsettled = uvec2(0u);
    int k = u_wavelengths - 1;
    while (true) {
        float weight = u_glass[k].z;
        onCasters += weight * entry.flux;
        landed[k] = vec3(at, 0.0);
        // One step may reflect a ray that would leave: it is searched again, unless the longest is reflected as well.
        if (met || (passed == kTotal && allReflected)) {
            landed[k].z = share(entry.flux, weight, passed, reflectance, u_glass[k].y, way, tally);
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
            passed = passThrough(entry, u_glass[k].x, kFollowSteps, way, exitNormal, origin, ray, reflectance);
            met = passed == kLeaves && followReceiver(u_mapView, u_receivers, origin, ray, true, meeting, at);
        }
    }
    depositAll(landed, pyramid.fineSize, pyramid.fineFirst, 1.0 - pyramid.coarseShare);
    depositAll(landed, pyramid.coarseSize, pyramid.coarseFirst, pyramid.coarseShare);
    if ((unsettled.x | unsettled.y) != 0u) {
        int left = bitCount(unsettled.x) + bitCount(unsettled.y);
        traceAgain(uvec4(index, floatBitsToUint(level), unsettled), 2 * left > u_wavelengths);
    }
    book(kLedgerOnCasters, onCasters);
    book(tally);
}
#endif
