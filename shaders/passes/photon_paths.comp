// Traces photons exactly: from the light to the first caster, through every surface of every caster with both branches
// followed, to the receivers; adds their flux to the spectral map in 64 bits. One thread a photon and wavelength: the
// wavelengths of a photon lie beside each other, as they take the same way for long. A photon's place depends on its
// number alone, so that any partition of the same photons into dispatches gives the same sums.
#include "shared/layout.h"
#include "common/view.glsl"
#include "common/emission.glsl"
#include "common/optics.glsl"
#include "common/surfaces.glsl"
#include "common/interfaces.glsl"
#include "common/lattice.glsl"
#include "common/residuals.glsl"
#include "common/receiver.glsl"

layout(local_size_x = kGroupSize) in;
// Two words a sum, the low one first. A texel of the map holds X, Y of the even photons, Y of the odd ones, Z; with BANDS
// a sum for each wavelength.
layout(std430, binding = kBindMap) buffer Map { uint map[]; };
layout(std430, binding = kBindOuterMap) buffer OuterMap { uint outerMap[]; };
layout(std430, binding = kBindLandings) buffer Landings { uint landings[]; };                // in each texel, whatever their flux
layout(std430, binding = kBindOuterLandings) buffer OuterLandings { uint outerLandings[]; };
layout(std430, binding = kBindLedger) buffer Ledger { uint ledger[]; };

uniform View u_emission, u_mapView, u_outerView;   // the outer view shares the map view's space
uniform mat4 u_emissionToWorld;
uniform sampler2D u_receivers, u_outerReceivers;   // of the map view, of the outer view
uniform uint u_firstPhoton, u_photons;             // of this dispatch
uniform int u_emitter;                             // the caster that must be met first
uniform int u_spectra;                             // wavelengths a photon
uniform int u_firstEntry, u_entries;               // of the spectral table: the first of this dispatch; how many
uniform float u_bandShare;                         // BANDS: luminance of one wavelength
uniform int u_receiverSteps;
uniform bool u_continuous;
uniform float u_fullExtent;                        // extent of a texel of the emission view where it is greatest, per image area
uniform float u_fixedPerFlux;                      // units of the map per photon's flux
uniform float u_ledgerPerFlux;
uniform int u_bounces;                             // reflections inside that are followed
uniform float u_least;                             // of a photon's flux: what is weaker is not followed
uniform float u_reach;                             // m: farther than any receiver

float g_rounding;                                  // added before rounding down: alike photons are not all rounded the same way
float g_flux;                                      // of the photon where it meets its caster, at this wavelength
vec3 g_color;                                      // map units per flux: XYZ, or with BANDS x alone
int g_word;                                        // within a texel: of the luminance of this photon's half, or of the band
struct Tally {
    float landed, absorbed, reflected, lost, left, missed, cut;
};
Tally g_tally;
const float kFar = 3.0e38;

void addTo(int word, uint amount) {
    if (amount == 0u) return;
    uint before = atomicAdd(map[word], amount);
    if (before + amount < before) atomicAdd(map[word + 1], 1u);
}

void addToOuter(int word, uint amount) {
    if (amount == 0u) return;
    uint before = atomicAdd(outerMap[word], amount);
    if (before + amount < before) atomicAdd(outerMap[word + 1], 1u);
}

int texelAt(vec2 uv, ivec2 size) {
    ivec2 texel = clamp(ivec2(uv * vec2(size)), ivec2(0), size - 1);
    return texel.x + texel.y * size.x;
}

void deposit(vec2 uv, bool outer, float flux) {
    g_tally.landed += flux;
    uvec3 amount = uvec3(g_color * flux + g_rounding);
    int texel = texelAt(uv, outer ? textureSize(u_outerReceivers, 0) : textureSize(u_receivers, 0));
    if (outer) atomicAdd(outerLandings[texel], 1u);
    else atomicAdd(landings[texel], 1u);
#if BANDS
    int word = 2 * (texel * u_entries + g_word);
    if (outer) addToOuter(word, amount.x);
    else addTo(word, amount.x);
#else
    int word = kWideWords * texel;
    if (outer) {
        addToOuter(word, amount.x);
        addToOuter(word + g_word, amount.y);
        addToOuter(word + kWideZ, amount.z);
    } else {
        addTo(word, amount.x);
        addTo(word + g_word, amount.y);
        addTo(word + kWideZ, amount.z);
    }
#endif
}

#if EXACT_RECEIVERS
// How far a point of a plane lies behind what a texel shows of it at its centre: 0 on the plane that is seen there, however
// slanted. `normal` is that of the plane.
float behindCentre(View view, sampler2D layer, vec3 pos, vec3 normal, vec2 uv) {
    ivec2 size = textureSize(layer, 0);
    ivec2 texel = clamp(ivec2(uv * vec2(size)), ivec2(0), size - 1);
    vec2 xy = (2.0 * (vec2(texel) + 0.5) / vec2(size) - 1.0) * view.halfExtent;
    vec3 centre;
    if (isPerspective(view)) {
        vec3 towards = vec3(xy, -1.0);
        centre = towards * (dot(normal, pos) / dot(normal, towards));
    } else {
        centre = vec3(xy, pos.z - dot(normal.xy, xy - pos.xy) / normal.z);
    }
    return behindLayer(view, centre, texelFetch(layer, texel, 0).x);
}

// Light on a receiver that the light itself does not see belongs to no texel of its map. Where nothing hides anything
// (HIDDEN 0) the place alone tells. `normal` is the receiver's there, in the view's space.
bool seen(View view, sampler2D layer, vec3 pos, vec3 normal, out vec2 uv) {
#if HIDDEN
    bool shown = abs(behindAt(view, layer, pos, uv)) <= kResidual || abs(behindCentre(view, layer, pos, normal, uv)) <= kResidual;
#else
    const bool shown = true;
    uv = viewToUv(view, pos);
#endif
    return shown && all(greaterThanEqual(uv, vec2(0.0))) && all(lessThanEqual(uv, vec2(1.0)));
}

// Ends a ray that meets a receiver before `most`, or nothing at all. False: a caster comes first.
bool land(vec3 origin, vec3 direction, float flux, float most) {
    Ground ground = nearestReceiver(origin, direction);
    if (ground.object < 0 || ground.t >= most) {
        g_tally.missed += most < kFar ? 0.0 : flux;
        return most >= kFar;
    }
    vec3 pos = (u_mapView.worldToView * vec4(origin + ground.t * direction, 1.0)).xyz;
    vec2 uv;
#if HIDDEN
    // A side that faces away from the light is not the one that its map shows, however near that is.
    vec3 against = mat3(u_mapView.worldToView) * ground.geometric;
    if (dot(ground.geometric, direction) > 0.0) against = -against;
    bool away = dot(against, u_mapView.perspective ? -pos : vec3(0.0, 0.0, 1.0)) <= 0.0;
#else
    const vec3 against = vec3(0.0);
    const bool away = false;
#endif
    if (away || (u_mapView.perspective && pos.z >= 0.0)) g_tally.left += flux;
    else if (seen(u_mapView, u_receivers, pos, against, uv)) deposit(uv, false, flux);
    else if (seen(u_outerView, u_outerReceivers, pos, against, uv)) deposit(uv, true, flux);
    else g_tally.left += flux;
    return true;
}
#else
bool land(vec3 origin, vec3 direction, float flux, float most) {
    vec3 from = (u_mapView.worldToView * vec4(origin, 1.0)).xyz, ray = mat3(u_mapView.worldToView) * direction;
    vec2 uv;
    Meeting met;
    bool outer = false;
    int found = findReceiver(u_mapView, u_receivers, from, ray, u_reach, u_receiverSteps, uv, met);
    if (found == kLeftView || found == kNoReceiver) {
        outer = true;
        found = findReceiver(u_outerView, u_outerReceivers, from, ray, u_reach, u_receiverSteps, uv, met);
    }
    if (found == kHit ? met.t >= most : most < kFar) return false;
    if (found == kHit) deposit(uv, outer, flux);
    g_tally.lost += found == kRejected ? flux : 0.0;
    g_tally.left += found == kLeftView ? flux : 0.0;
    g_tally.missed += found == kNoReceiver ? flux : 0.0;
    return true;
}
#endif

float absorb(float flux, float perM, float way) {
    float through = flux * exp(-perM * way);
    g_tally.absorbed += flux - through;
    return through;
}

#if LONE
const int kMostExits = 33;   // of the most reflections that may be asked for
// One convex caster alone: what leaves it does not come back, and the way inside ends at the nearest plane ahead.
void follow(vec3 origin, vec3 direction, Surface surface, int entry) {
    vec4 glass = glassAt(entry, surface.caster);
    Crossing in_ = crossingAt(surface, direction, outsideAll(), entry);
    g_tally.reflected += g_flux * in_.reflectance;
    float flux = g_flux * (1.0 - in_.reflectance), eta = glass.x / u_outsideIndex;
    vec3 at = surface.point, way = in_.transmitted;
    // Where it leaves, and with how much: landed after the way inside, so that no lane waits for another's landing
    vec3 exits[kMostExits], ways[kMostExits];
    float fluxes[kMostExits];
    int exitCount = 0;
    for (int bounce = 0; bounce <= u_bounces && flux > u_least * g_flux; ++bounce) {
        Surface exit = exitOf(surface.caster, at, way);
        at = exit.point;
        flux = absorb(flux, glass.y, exit.t);
        vec3 outside;
        float R;
        refractDielectric(way, -exit.geometric, eta, outside, R);
        float leaves = flux * (1.0 - R);
        if (leaves > 0.0) {
            exits[exitCount] = at;
            ways[exitCount] = outside;
            fluxes[exitCount] = leaves;
            ++exitCount;
        }
        flux -= leaves;
        way = reflect(way, exit.geometric);
    }
    g_tally.cut += flux;
    for (int i = 0; i < exitCount; ++i) land(exits[i], ways[i], fluxes[i], kFar);
}
#else
struct Branch {
    vec3 origin, direction;
    float flux;
    Inside inside;
    int piece;            // that it starts on
    int bounces;          // reflections so far
};
const int kMostBranches = 6;      // that wait

void follow(vec3 origin, vec3 direction, Surface surface, int entry) {
    Branch waiting[kMostBranches];
    int count = 0, steps = 8 * (u_bounces + 4);
    Branch now = Branch(origin, direction, g_flux, outsideAll(), -1, 0);
    bool first = true;
    while (true) {
        if (!first) surface = nearestSurface(now.origin, now.direction, now.piece, now.inside.casters);
        int medium = mediumOf(now.inside);
        bool ended = false;
        if (--steps < 0 || surface.caster == kLost) {
            g_tally.cut += now.flux;
            ended = true;
        } else if (medium == kOutside && !first) {
            ended = land(now.origin, now.direction, now.flux, surface.caster < 0 ? kFar : surface.t);
        } else if (surface.caster < 0) {   // an open mesh let it through
            g_tally.lost += now.flux;
            ended = true;
        }
        if (!ended) {
            Crossing c = crossingAt(surface, now.direction, now.inside, entry);
            float flux = absorb(now.flux, absorptionOf(entry, medium), surface.t);
            float back = c.straight ? 0.0 : flux * c.reflectance, on = flux - back;
            // A mirror keeps what it does not reflect; what the first glass throws back is booked, not followed.
            g_tally.absorbed += c.mirror ? on : 0.0;
            on = c.mirror ? 0.0 : on;
            bool thrown = first && !c.mirror;
            g_tally.reflected += thrown ? back : 0.0;
            back = thrown ? 0.0 : back;

            vec3 ahead = c.straight ? now.direction : c.transmitted;
            bool goesBack = back > u_least * g_flux && now.bounces < u_bounces && count < kMostBranches;
            bool goesOn = on > u_least * g_flux;
            g_tally.cut += (goesBack ? 0.0 : back) + (goesOn ? 0.0 : on);
            Branch reflected = Branch(surface.point, c.reflected, back, now.inside, surface.piece, now.bounces + 1);
            now = Branch(surface.point, ahead, on, c.beyond, surface.piece, now.bounces);
            ended = !goesOn;
            if (goesBack) {
                waiting[count] = reflected;
                ++count;
            }
        }
        first = false;
        if (ended) {
            if (count == 0) return;
            --count;
            now = waiting[count];
        }
    }
}
#endif

void book(int row, float flux) {
    uint bank = (gl_WorkGroupID.x % uint(kLedgerBanks)) * uint(kLedgerRows);
    if (flux > 0.0) atomicAdd(ledger[bank + uint(row)], uint(flux * u_ledgerPerFlux + g_rounding));
}

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= u_photons * uint(u_spectra)) return;
    uint photon = u_firstPhoton + id / uint(u_spectra);
    int k = int(id % uint(u_spectra));
    vec2 uv = latticeDirection(photon);
    vec3 towards = viewDirection(u_emission, uv);
    g_flux = emittedShare(towards) * texelExtent(u_emission, uv, vec2(1.0)) / u_fullExtent;
    if (g_flux <= 0.0) return;

    vec3 start = u_emission.perspective ? vec3(0.0) : vec3((2.0 * uv - 1.0) * u_emission.halfExtent, 0.0);
    vec3 origin = (u_emissionToWorld * vec4(start, 1.0)).xyz, direction = mat3(u_emissionToWorld) * towards;
    Surface surface = nearestSurface(origin, direction, -1);
    if (surface.caster != u_emitter) return;
#if EXACT_RECEIVERS
    Ground ground = nearestReceiver(origin, direction);
    if (ground.object >= 0 && ground.t < surface.t) return;
#endif

    float share = u_continuous ? 1.0 / float(u_spectra) : 1.0;
    int entry = u_continuous ? min(int((float(k) + latticeWavelength(photon)) * share * float(u_entries)), u_entries - 1) : u_firstEntry + k;
    vec4 color = texelFetch(u_colours, entry);
    g_rounding = float((photon * 2654435769u + uint(k) * 805459861u) >> 8) * kLatticeUnit;
    g_tally = Tally(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
#if BANDS
    g_word = k;
    g_color = vec3(u_fixedPerFlux, 0.0, 0.0);
    float luminance = u_bandShare;
#else
    g_word = kWideEvenY + 2 * int(photon & 1u);
    g_color = color.xyz * (share * u_fixedPerFlux);
    float luminance = color.w * share;
#endif
    follow(origin, direction, surface, entry);
    // llvmpipe ends all loops of a thread after 65,535 turns: what was still on its way then is cut, and said to be.
    float way = g_flux - g_tally.landed - g_tally.absorbed - g_tally.reflected - g_tally.lost - g_tally.left - g_tally.missed - g_tally.cut;
    g_tally.cut += way > 1e-3 * g_flux ? way : 0.0;

    book(kLedgerOnCasters, luminance * g_flux);
    book(kLedgerAbsorbed, luminance * g_tally.absorbed);
    book(kLedgerReflected, luminance * g_tally.reflected);
    book(kLedgerRejected, luminance * g_tally.lost);
    book(kLedgerLeftMap, luminance * g_tally.left);
    book(kLedgerNoReceiver, luminance * g_tally.missed);
    book(kLedgerCut, luminance * g_tally.cut);
    if (k == 0) {
        uint bank = (gl_WorkGroupID.x % uint(kLedgerBanks)) * uint(kLedgerRows);
        atomicAdd(ledger[bank + uint(kLedgerPhotons)], 1u);
    }
}
