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
layout(std430, binding = kBindMap) buffer Map { uint map[]; };          // texel-major; the outer map after the inner
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
uniform int u_backSteps, u_receiverSteps;
uniform float u_exitTolerance;                 // m
uniform float u_reach;                         // m: farther than any receiver

// 2x2 bilinear deposit; texels beyond the border take their neighbour's share.
void deposit(vec2 uv, ivec2 size, int firstTexel, int k, float flux) {
    vec2 at = clamp(uv * vec2(size) - 0.5, vec2(0.0), vec2(size) - 1.0);
    ivec2 base = min(ivec2(at), max(size - 2, ivec2(0)));
    vec2 f = at - vec2(base);
    float fixedFlux = flux * u_fixedPerFlux;
    for (int i = 0; i < 4; ++i) {
        ivec2 offset = ivec2(i & 1, i >> 1);
        vec2 share = mix(1.0 - f, f, vec2(offset));
        float part = fixedFlux * share.x * share.y;
        ivec2 texel = base + offset;
        int index = firstTexel + texel.x + texel.y * size.x;
#if BANDS
        atomicAdd(map[index * u_bands + int(u_glass[k].w)], uint(part + 0.5));
#else
        uvec3 amount = uvec3(part * u_xyz[k].xyz + 0.5);
        atomicAdd(map[index * 3], amount.x);
        atomicAdd(map[index * 3 + 1], amount.y);
        atomicAdd(map[index * 3 + 2], amount.z);
#endif
    }
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
    float guess = 50.0 * u_exitTolerance;
    if (sampleLayer(u_back, backUv, behind)) guess = max(distance(layerToView(u_backView, backUv, behind.w), entry), u_exitTolerance);

    float booked[kLedgerRows];
    for (int i = 0; i < kLedgerRows; ++i) booked[i] = 0.0;
    for (int k = 0; k < u_wavelengths; ++k) {
        float eta = u_glass[k].x;
        float weight = u_glass[k].z;      // luminance, for the ledger
        float flux = emitted;
        booked[kLedgerOnCasters] += flux * weight;

        vec3 inside, outside, exitNormal;
        float reflectance;
        if (!refractDielectric(direction, entryNormal, eta, inside, reflectance)) {
            booked[kLedgerTotalReflection] += flux * weight;
            continue;
        }
        booked[kLedgerReflected] += flux * reflectance * weight;
        flux *= 1.0 - reflectance;

        float way = guess;
        if (!findExit(u_backView, u_back, entry, inside, u_backSteps, u_exitTolerance, way, exitNormal)) {
            booked[kLedgerRejected] += flux * weight;
            continue;
        }
        float kept = exp(-u_glass[k].y * way);
        booked[kLedgerAbsorbed] += flux * (1.0 - kept) * weight;
        flux *= kept;

        if (!refractDielectric(inside, -exitNormal, 1.0 / eta, outside, reflectance)) {
            booked[kLedgerTotalReflection] += flux * weight;
            continue;
        }
        booked[kLedgerReflected] += flux * reflectance * weight;
        flux *= 1.0 - reflectance;

        vec3 origin = (u_backToMap * vec4(entry + way * inside, 1.0)).xyz;
        vec3 ray = mat3(u_backToMap) * outside;
        vec2 met;
        int found = findReceiver(u_mapView, u_receivers, origin, ray, u_reach, u_receiverSteps, met);
        if (found == kHit) {
            deposit(met, textureSize(u_receivers, 0), 0, k, flux);
            continue;
        }
        if (found != kRejected) {
            found = findReceiver(u_outerView, u_outerReceivers, origin, ray, u_reach, u_receiverSteps, met);
        }
        if (found == kHit) {
            ivec2 inner = textureSize(u_receivers, 0);
            deposit(met, textureSize(u_outerReceivers, 0), inner.x * inner.y, k, flux);
        } else {
            int row = found == kRejected ? kLedgerRejected : found == kLeftView ? kLedgerLeftMap : kLedgerNoReceiver;
            booked[row] += flux * weight;
        }
    }

    uint bank = (gl_WorkGroupID.x % uint(kLedgerBanks)) * uint(kLedgerRows);
    for (int i = 0; i < kLedgerDeposited; ++i) {
        if (booked[i] > 0.0) atomicAdd(ledger[bank + uint(i)], uint(booked[i] * u_ledgerPerFlux + 0.5));
    }
}
