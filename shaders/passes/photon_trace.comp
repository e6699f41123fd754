// Traces each listed photon at its wavelengths through two interfaces to the receivers and deposits its flux in the
// spectral map, in fixed point: the sums are the same whatever the order.
#include "shared/layout.h"
#include "common/view.glsl"
#include "common/emission.glsl"
#include "common/optics.glsl"
#include "common/layer.glsl"
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

// Where a photon lands: the lowest of 2x2 texels and the place between them. Texels beyond the border give their share
// to their neighbour.
struct Place {
    int texel;        // index of the lowest texel; -1: nowhere
    int width;        // texels of its map in a row
    vec2 f;
};

Place placeAt(vec2 uv, ivec2 size, int firstTexel) {
    vec2 at = clamp(uv * vec2(size) - 0.5, vec2(0.0), vec2(size) - 1.0);
    ivec2 base = min(ivec2(at), size - 2);
    return Place(firstTexel + base.x + base.y * size.x, size.x, at - vec2(base));
}

int firstTexelOf(int level, ivec2 size) {
    int first = 0;
    for (int i = 0; i < level; ++i) first += (size.x >> i) * (size.y >> i);
    return first;
}

vec4 shares(vec2 f) {
    return vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
}

int cornerOf(Place place, int i) { return place.texel + (i & 1) + (i >> 1) * place.width; }

#if BANDS
void deposit(Place place, int k, float flux) {
    vec4 share = shares(place.f) * (flux * u_fixedPerFlux);
    for (int i = 0; i < 4; ++i) atomicAdd(map[cornerOf(place, i) * u_bands + int(u_glass[k].w)], uint(share[i] + 0.5));
}
#else
// Neighbouring wavelengths mostly land in the same texels: their XYZ is gathered here and written once.
struct Pending {
    Place place;
    vec3 corner0, corner1, corner2, corner3;
};

void addTo(int texel, vec3 xyz) {
    uvec3 amount = uvec3(xyz + 0.5);
    atomicAdd(map[texel * 3], amount.x);
    atomicAdd(map[texel * 3 + 1], amount.y);
    atomicAdd(map[texel * 3 + 2], amount.z);
}

void flush(inout Pending pending) {
    if (pending.place.texel < 0) return;
    addTo(cornerOf(pending.place, 0), pending.corner0);
    addTo(cornerOf(pending.place, 1), pending.corner1);
    addTo(cornerOf(pending.place, 2), pending.corner2);
    addTo(cornerOf(pending.place, 3), pending.corner3);
    pending.corner0 = pending.corner1 = pending.corner2 = pending.corner3 = vec3(0.0);
    pending.place.texel = -1;
}

void deposit(inout Pending pending, Place place, int k, float flux) {
    if (place.texel != pending.place.texel) flush(pending);
    vec4 share = shares(place.f) * (flux * u_fixedPerFlux);
    vec3 xyz = u_xyz[k].xyz;
    pending.place = place;
    pending.corner0 += share.x * xyz;
    pending.corner1 += share.y * xyz;
    pending.corner2 += share.z * xyz;
    pending.corner3 += share.w * xyz;
}
#endif

void book(int row, float flux) {
    uint bank = (gl_WorkGroupID.x % uint(kLedgerBanks)) * uint(kLedgerRows);
    if (flux > 0.0) atomicAdd(ledger[bank + uint(row)], uint(flux * u_ledgerPerFlux + 0.5));
}

const float kLevelBias = 0.6;   // photons a texel apart show their lattice in texels of just that width

// The way of one photon at one wavelength, as far as its neighbours go the same.
struct Path {
    float way;            // inside the caster, m
    Meeting meeting;      // with the receivers, in the map view
    vec3 exitNormal;
};

// Where the photon of a neighbouring texel lands in the inner map; false when it takes another way: another facet, a step
// in depth, another receiver.
bool neighbourLanding(ivec2 texel, vec4 own, float eta, Path path, out vec2 at) {
    ivec2 size = textureSize(u_front, 0);
    at = vec2(0.0);
    vec4 front = texelFetch(u_front, clamp(texel, ivec2(0), size - 1), 0);
    if (dot(front.xyz, own.xyz) < kSameSurfaceCos || abs(front.w - own.w) > 0.05 * own.w) return false;
    vec2 uv = (vec2(texel) + 0.5) / vec2(size);
    mat3 turn = mat3(u_emissionToBack);
    vec3 entry = (u_emissionToBack * vec4(layerToView(u_emission, uv, front.w), 1.0)).xyz;
    vec3 inside, outside, exitNormal;
    float reflectance;
    if (!refractDielectric(turn * viewDirection(u_emission, uv), turn * front.xyz, eta, inside, reflectance)) return false;
    if (!findExit(u_backView, u_back, entry, inside, 2, u_exitTolerance, path.way, exitNormal)) return false;
    if (dot(exitNormal, path.exitNormal) < kSameSurfaceCos) return false;
    if (!refractDielectric(inside, -exitNormal, 1.0 / eta, outside, reflectance)) return false;
    vec3 origin = (u_backToMap * vec4(entry + path.way * inside, 1.0)).xyz;
    return followReceiver(u_mapView, u_receivers, origin, mat3(u_backToMap) * outside, path.meeting, at);
}

// Level of the pyramid whose texels are as wide as the photons lie apart around `at`, so that they neither leave holes
// nor blur what they resolve. Between two levels a photon's flux is split, so that no edge shows where they change.
float levelAt(ivec2 texel, vec4 front, float eta, Path path, vec2 at) {
    vec2 mapSize = vec2(textureSize(u_receivers, 0));
    float apart = -1.0;
    for (int axis = 0; axis < 2; ++axis) {
        ivec2 offset = axis == 0 ? ivec2(1, 0) : ivec2(0, 1);
        vec2 other;
        if (neighbourLanding(texel + offset, front, eta, path, other) || neighbourLanding(texel - offset, front, eta, path, other)) {
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
    vec2 uv = (vec2(texel) + 0.5) / vec2(size);

    // Entry point, in the back view's space from here on
    vec4 front = texelFetch(u_front, texel, 0);
    vec3 direction = viewDirection(u_emission, uv);
    float emitted = emittedShare(direction) * texelExtent(u_emission, uv, 1.0 / vec2(size));
    mat3 turn = mat3(u_emissionToBack);
    vec3 entry = (u_emissionToBack * vec4(layerToView(u_emission, uv, front.w), 1.0)).xyz;
    vec3 entryNormal = turn * front.xyz;
    direction = turn * direction;

    // First guess of the way inside: along the light's own ray
    vec2 backUv = viewToUv(u_backView, entry);
    vec4 behind;
    float guess = 5.0 * u_exitTolerance;
    if (sampleLayer(u_back, backUv, behind)) guess = max(distance(layerToView(u_backView, backUv, behind.w), entry), 0.01 * u_exitTolerance);

    ivec2 innerSize = textureSize(u_receivers, 0);
    ivec2 outerSize = textureSize(u_outerReceivers, 0);
    float level = -1.0;               // not known yet
    ivec2 fineSize = innerSize;
    int fineFirst = 0;
    float coarseShare = 0.0;          // of the flux, for the next coarser level
    ivec2 coarseSize = innerSize;
    int coarseFirst = 0;
#if !BANDS
    Pending pending = Pending(Place(-1, 0, vec2(0.0)), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    Pending pendingCoarse = pending;
#endif
    float onCasters = 0.0, absorbed = 0.0, reflected = 0.0, total = 0.0, rejected = 0.0, left = 0.0, missed = 0.0;
    float way = guess;
    int backSteps = u_backSteps;
    Meeting meeting = Meeting(0.0, 0.0);
    for (int k = 0; k < u_wavelengths; ++k) {
        float eta = u_glass[k].x;
        float weight = u_glass[k].z;      // luminance, for the ledger
        float flux = emitted;
        onCasters += flux * weight;

        vec3 inside, outside, exitNormal;
        float reflectance;
        if (!refractDielectric(direction, entryNormal, eta, inside, reflectance)) {
            total += flux * weight;
            continue;
        }
        reflected += flux * reflectance * weight;
        flux *= 1.0 - reflectance;

        if (!findExit(u_backView, u_back, entry, inside, backSteps, u_exitTolerance, way, exitNormal)) {
            rejected += flux * weight;
            way = guess;
            backSteps = u_backSteps;
            continue;
        }
        backSteps = (u_backSteps + 1) / 2;   // the next wavelength starts where this one left
        float kept = exp(-u_glass[k].y * way);
        absorbed += flux * (1.0 - kept) * weight;
        flux *= kept;

        if (!refractDielectric(inside, -exitNormal, 1.0 / eta, outside, reflectance)) {
            total += flux * weight;
            continue;
        }
        reflected += flux * reflectance * weight;
        flux *= 1.0 - reflectance;

        vec3 origin = (u_backToMap * vec4(entry + way * inside, 1.0)).xyz;
        vec3 ray = mat3(u_backToMap) * outside;
        vec2 at;
        Place place;
        int found = kHit;
        bool inInner = true;
        if (followReceiver(u_mapView, u_receivers, origin, ray, meeting, at)) {
            place = placeAt(at, fineSize, fineFirst);
        } else {
            found = findReceiver(u_mapView, u_receivers, origin, ray, u_reach, u_receiverSteps, at, meeting);
            if (found == kHit && level < 0.0) {
                level = u_levels > 1 ? levelAt(texel, front, eta, Path(way, meeting, exitNormal), at) : 0.0;
                int fine = int(level);
                fineSize = innerSize >> fine;
                fineFirst = firstTexelOf(fine, innerSize);
                coarseShare = level - float(fine);
                coarseSize = innerSize >> (fine + 1);
                coarseFirst = firstTexelOf(fine + 1, innerSize);
            }
            inInner = found == kHit;
            place = placeAt(at, fineSize, fineFirst);
            if (found == kLeftView || found == kNoReceiver) {
                found = findReceiver(u_outerView, u_outerReceivers, origin, ray, u_reach, u_receiverSteps, at, meeting);
                place = placeAt(at, outerSize, firstTexelOf(u_levels, innerSize));
                meeting.slope = 0.0;      // of another view
            }
        }
        if (found == kHit) {
            float coarse = inInner ? coarseShare : 0.0;
#if BANDS
            deposit(place, k, flux * (1.0 - coarse));
            if (coarse > 0.0) deposit(placeAt(at, coarseSize, coarseFirst), k, flux * coarse);
#else
            deposit(pending, place, k, flux * (1.0 - coarse));
            if (coarse > 0.0) deposit(pendingCoarse, placeAt(at, coarseSize, coarseFirst), k, flux * coarse);
#endif
        } else if (found == kRejected) {
            rejected += flux * weight;
        } else if (found == kLeftView) {
            left += flux * weight;
        } else {
            missed += flux * weight;
        }
    }
#if !BANDS
    flush(pending);
    flush(pendingCoarse);
#endif
    book(kLedgerOnCasters, onCasters);
    book(kLedgerAbsorbed, absorbed);
    book(kLedgerReflected, reflected);
    book(kLedgerTotalReflection, total);
    book(kLedgerRejected, rejected);
    book(kLedgerLeftMap, left);
    book(kLedgerNoReceiver, missed);
}
