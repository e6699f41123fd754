// A continuous spectrum between few exact wavelengths, the nodes: samples of the spectrum land where interpolation puts
// them, each with the colour of its own part of the band, so that every part of it arrives once whatever the samples.
// Interpolated only between nodes that land on one surface; what lies between others is traced (RETRY 1).
uniform vec4 u_cumulative[kSpectrumSteps + 1];  // XYZ up to a place of the band, violet to red, uniform in 1/lambda^2; n outside / n inside there
#if ABSORPTION
uniform float u_absorption[kSpectrumSteps + 1]; // 1/m
#endif
#ifndef kNodes
#define kNodes 4
#endif
const int kIntervals = kNodes - 1;
const float kGreen = 0.7;                       // place of the band where most of its luminance lies
const float kOneSurface = 2e-3;                 // of the depth: the middle of two nodes lies on their surface within this
const int kMostSamples = 12;                    // of a photon's spectrum
const int kSampleRoom = kMostSamples + 1 + kNodes;   // the first and the last are parts, and so where intervals are left out
const float kSparse = 4.0;                      // texels of a sample beyond which it is spread over wider ones
const int kTracedSamples = 3;                   // of an interval that cannot be interpolated

// Linear in the table at `place` of the band, 0 (violet) to 1.
vec4 spectrumAt(float place) {
    float at = place * float(kSpectrumSteps);
    int step = min(int(at), kSpectrumSteps - 1);
    return mix(u_cumulative[step], u_cumulative[step + 1], at - float(step));
}
float absorptionAt(float place) {
#if ABSORPTION
    float at = place * float(kSpectrumSteps);
    int step = min(int(at), kSpectrumSteps - 1);
    return mix(u_absorption[step], u_absorption[step + 1], at - float(step));
#else
    return 0.0;
#endif
}

// Where in a sample's width a photon's first one ends. Interleaved gradient noise (Jimenez 2014): neighbours differ evenly,
// and no long period beats against the map's texels.
float phaseOf(ivec2 texel) { return fract(52.9829189 * fract(dot(vec2(texel), vec2(0.06711056, 0.00583715)))); }

#if RETRY
// The last sample traced, held back until the next one tells how far apart they land.
struct Held {
    bool landed;
    vec2 at;
    float apart;       // texels of the finest level; 0: no sample before it on its surface
    vec3 amount;       // fixed-point units
};

// Spread as wide as the samples lie apart: a jump to another surface is no gap, so the nearer neighbour counts.
void depositHeld(Held held, float apart, float ownLevel, ivec2 innerSize) {
    float gap = min(apart > 0.0 ? apart : held.apart, held.apart > 0.0 ? held.apart : apart);
    Level level = levelOf(clamp(max(ownLevel, log2(max(gap, 1e-3))), 0.0, float(u_levels - 1)), innerSize);
    deposit(placeAt(held.at, level.fineSize, level.fineFirst), held.amount * (1.0 - level.coarseShare));
    if (level.coarseShare > 0.0) deposit(placeAt(held.at, level.coarseSize, level.coarseFirst), held.amount * level.coarseShare);
}

void main() {
    uint item = gl_GlobalInvocationID.x;
    if (item >= retriesListed()) return;
    uvec4 retry = retryAt(item);
    roundBy(retry.x);
    ivec2 size = textureSize(u_front, 0);
    ivec2 texel = ivec2(retry.x % uint(size.x), retry.x / uint(size.x));
    photonHalf = halfOf(texel);
    Entry entry = entryAt(texel);
    float guess = guessWay(entry), ownLevel = uintBitsToFloat(retry.y);
    ivec2 innerSize = textureSize(u_receivers, 0), outerSize = textureSize(u_outerReceivers, 0);
    int outerFirst = firstTexelOf(u_levels, innerSize);

    float phase = phaseOf(texel);
    Tally tally = Tally(0.0, 0.0, 0.0);
    float rejected = 0.0, left = 0.0, missed = 0.0;
    uint remaining = retry.z;
    while (remaining != 0u) {
        int interval = findLSB(remaining);
        bool dark = (retry.w & (1u << interval)) != 0u;
        remaining &= remaining - 1u;
        Held held = Held(false, vec2(0.0), 0.0, vec3(0.0));
        float first = float(interval) / float(kIntervals), last = float(interval + 1) / float(kIntervals), from = first;
        vec3 before = spectrumAt(first).xyz;
        // Where neither end lands, one sample of the whole interval (j = 0) is enough unless that lands.
        for (int j = dark ? 0 : 1; j <= kTracedSamples + 1; ++j) {
            Held next = Held(false, vec2(0.0), 0.0, vec3(0.0));
            bool trial = j == 0;
            float to = trial ? last : mix(first, last, min((float(j) - phase) / float(kTracedSamples), 1.0));
            float place = 0.5 * (from + to), way = guess;
            vec3 upTo = spectrumAt(to).xyz, colour = max(upTo - before, vec3(0.0)), exitNormal, origin, ray;
            vec2 reflectance;
            int passed = passThrough(entry, spectrumAt(place).w, u_backSteps, way, exitNormal, origin, ray, reflectance);
            Tally own = Tally(0.0, 0.0, 0.0);
            float flux = share(entry.flux, colour.y, passed, reflectance, absorptionAt(place), way, own);
            int found = passed == kLeaves ? kLeftView : kRejected;
            if (passed == kLeaves) {
                Meeting met;
                found = findReceiver(u_mapView, u_receivers, origin, ray, u_reach, u_receiverSteps, next.at, met);
                next.landed = found == kHit && !trial;
                next.amount = colour * (flux * u_fixedPerFlux);
                if (found == kLeftView || found == kNoReceiver) {
                    vec2 at;
                    found = findReceiver(u_outerView, u_outerReceivers, origin, ray, u_reach, u_receiverSteps, at, met);
                    if (found == kHit && !trial) deposit(placeAt(at, outerSize, outerFirst), next.amount);
                }
            }
            bool lost = found != kHit;
            if (!trial || lost) {
                tally = Tally(tally.absorbed + own.absorbed, tally.reflected + own.reflected, tally.total + own.total);
                rejected += found == kRejected ? colour.y * flux : 0.0;   // nothing is left of what is reflected totally
                left += found == kLeftView ? colour.y * flux : 0.0;
                missed += found == kNoReceiver ? colour.y * flux : 0.0;
                before = upTo;
                from = to;
            }
            float apart = held.landed && next.landed ? length((next.at - held.at) * vec2(innerSize)) : 0.0;
            if (held.landed) depositHeld(held, apart, ownLevel, innerSize);
            next.apart = apart;
            held = next;
            if (trial && lost) break;
        }
        if (held.landed) depositHeld(held, 0.0, ownLevel, innerSize);
    }
    book(tally);
    book(kLedgerRejected, rejected);
    book(kLedgerLeftMap, left);
    book(kLedgerNoReceiver, missed);
}
#else

// Neighbouring samples mostly land in the same texels: a run of them is gathered and written once.
void depositSamples(vec2 landed[kSampleRoom], vec3 amount[kSampleRoom], int samples, ivec2 size, int firstTexel, float part) {
    int j = part > 0.0 ? 0 : samples;
    while (j < samples) {
        Place place = placeAt(landed[j], size, firstTexel);
        vec3 corner0 = vec3(0.0), corner1 = vec3(0.0), corner2 = vec3(0.0), corner3 = vec3(0.0);
        int run = place.texel;
        while (run == place.texel) {
            vec4 parts = shares(place.f) * part;
            corner0 += parts.x * amount[j];
            corner1 += parts.y * amount[j];
            corner2 += parts.z * amount[j];
            corner3 += parts.w * amount[j];
            ++j;
            if (j >= samples) break;
            place = placeAt(landed[j], size, firstTexel);
        }
        addTo(run, corner0);
        addTo(run + 1, corner1);
        addTo(run + size.x, corner2);
        addTo(run + size.x + 1, corner3);
    }
}

struct Node {
    vec2 at;           // uv of the inner map
    float layer;       // the receiver's layer value
#if ABSORPTION
    float way;         // inside the caster, m
    vec2 reflectance;
#else
    float through;     // of the light, what both interfaces let through
#endif
};

void main() {
    uint photon = gl_GlobalInvocationID.x;
    if (photon >= count) return;
    ivec2 size = textureSize(u_front, 0);
    uint index = texels[photon];
    roundBy(index);
    ivec2 texel = ivec2(index % uint(size.x), index / uint(size.x));
    photonHalf = halfOf(texel);
    Entry entry = entryAt(texel);
    ivec2 innerSize = textureSize(u_receivers, 0);

    // The longest wavelength's way, and how far its neighbours land
    float way = guessWay(entry), level = float(u_levels - 1);
    vec3 exitNormal, origin, ray;
    vec2 at, reflectance;
    Meeting meeting = Meeting(0.0, 0.0);
    int passed = passThrough(entry, u_glass[kIntervals].x, u_backSteps, way, exitNormal, origin, ray, reflectance);
    bool allReflected = passed == kTotal, met = false;
    if (passed == kLeaves) {
        met = findReceiver(u_mapView, u_receivers, origin, ray, u_reach, u_receiverSteps, at, meeting) == kHit;
        if (!met) meeting.slope = 0.0;
        if (u_levels > 1 && met) level = levelAt(texel, entry.layer, way, exitNormal, meeting, at);
    }

    // All nodes from there, and which of the intervals between them lie on one surface. Their number is fixed, so that
    // loops over them unroll and nodes live in registers.
    Node nodes[kNodes];
    Tally tally = Tally(0.0, 0.0, 0.0);
    float lastWay = way, spread = 0.0;
    uint bridged = 0u, broken = 0u, dark = 0u;
    bool lastMet = false, lastTotal = false;
    for (int k = kIntervals; k >= 0; --k) {
        // Glass that does not differ has no other way: white stays white at the rim too, where steps hardly settle.
        if (k < kIntervals && u_glass[k].x != u_glass[k + 1].x) {
            float ahead = way + (way - lastWay);
            lastWay = way;
            way = ahead;
            passed = passThrough(entry, u_glass[k].x, kFollowSteps, way, exitNormal, origin, ray, reflectance);
            met = passed == kLeaves && followReceiver(u_mapView, u_receivers, origin, ray, true, meeting, at);
        }
        nodes[k].at = at;
        nodes[k].layer = layerOf(u_mapView, origin + meeting.t * ray);
#if ABSORPTION
        nodes[k].way = way;
        nodes[k].reflectance = reflectance;
#else
        nodes[k].through = (1.0 - reflectance.x) * (1.0 - reflectance.y);
#endif
        bool total = passed == kTotal && allReflected;
        if (k < kIntervals) {
            vec2 middle = 0.5 * (at + nodes[k + 1].at);
            float straight = 0.5 * (nodes[k].layer + nodes[k + 1].layer);
            bool oneSurface = abs(textureLod(u_receivers, middle, 0.0).x - straight) <= kOneSurface * straight;
            if (met && lastMet && oneSurface) {
                bridged |= 1u << k;
                spread += length((at - nodes[k + 1].at) * vec2(innerSize));
            } else if (total && lastTotal) {
                share(entry.flux, u_glass[k].z, passed, reflectance, u_glass[k].y, way, tally);
            } else {
                broken |= 1u << k;
                dark |= met || lastMet ? 0u : 1u << k;
            }
        }
        lastMet = met;
        lastTotal = total;
    }

    // Where the way from node to node bends: half the mean second difference of an interval's ends (Bessel's interpolation),
    // from neighbouring intervals of the same surface.
    vec2 bend[kIntervals];
    for (int i = 0; i < kIntervals; ++i) {
        int before = max(i - 1, 0), after = min(i + 1, kIntervals - 1);
        bool hasBefore = i > 0 && (bridged & (1u << before)) != 0u, hasAfter = i < kIntervals - 1 && (bridged & (1u << after)) != 0u;
        vec2 step = nodes[i + 1].at - nodes[i].at;
        vec2 atFirst = hasBefore ? step - (nodes[i].at - nodes[before].at) : vec2(0.0);
        vec2 atLast = hasAfter ? nodes[after + 1].at - nodes[i + 1].at - step : vec2(0.0);
        vec2 sum = 0.5 * (atFirst + atLast) * (hasBefore && hasAfter ? 0.5 : 1.0);
        bend[i] = dot(sum, sum) <= 0.25 * dot(step, step) ? sum : vec2(0.0);
    }

    // Twice as many samples as texels lie under the spectrum, or fewer: then those of neighbouring photons lie between them,
    // as each begins at another place of the band. Bins end at the nodes where an interval is left out.
    float most = float(kMostSamples);
    level = clamp(max(level, log2(max(spread / (kSparse * most), 1e-3))), 0.0, float(u_levels - 1));
    float wanted = clamp(ceil(2.0 * spread * exp2(-level)), 1.0, most);
    float phase = wanted < 3.0 ? 0.0 : phaseOf(texel), parts = float(kIntervals), from = 0.0;
    Level pyramid = levelOf(level, innerSize);
    photonWidth = clamp(max(photonWidth, kOverlap * spread * exp2(-level) / wanted), kNarrowest, 1.0);
    vec3 before = vec3(0.0);
    vec2 landed[kSampleRoom];
    vec3 amount[kSampleRoom];
    int samples = 0, edge = 1;
    while (from < 1.0 && bridged != 0u && samples < kSampleRoom) {
        float next = (float(edge) - phase) / wanted;
        float to = min(next, broken != 0u ? (floor(from * parts + 1e-3) + 1.0) / parts : 1.0);
        edge += next <= to ? 1 : 0;
        float place = wanted == 1.0 && broken == 0u ? kGreen : 0.5 * (from + to);
        vec3 upTo = spectrumAt(to).xyz, colour = max(upTo - before, vec3(0.0));
        before = upTo;
        from = to;
        int i = min(int(place * parts), kIntervals - 1);
        float f = clamp(place * parts - float(i), 0.0, 1.0);
        Node a = nodes[0], b = nodes[1];
        vec2 turn = bend[0];
        for (int n = 1; n < kIntervals; ++n) {   // by hand: an index that differs between photons is looked up in memory
            if (i == n) a = nodes[n], b = nodes[n + 1], turn = bend[n];
        }
        float flux = (bridged & (1u << i)) != 0u ? entry.flux : 0.0;
#if ABSORPTION
        flux = share(flux, colour.y, kLeaves, mix(a.reflectance, b.reflectance, f), absorptionAt(place),
                     mix(a.way, b.way, f), tally);
#else
        float through = mix(a.through, b.through, f);
        tally.reflected += colour.y * flux * (1.0 - through);
        flux *= through;
#endif
        landed[samples] = mix(a.at, b.at, f) - f * (1.0 - f) * turn;
        amount[samples] = colour * (flux * u_fixedPerFlux);
        ++samples;
    }
    depositSamples(landed, amount, samples, pyramid.fineSize, pyramid.fineFirst, 1.0 - pyramid.coarseShare);
    depositSamples(landed, amount, samples, pyramid.coarseSize, pyramid.coarseFirst, pyramid.coarseShare);
    if (broken != 0u) traceAgain(uvec4(index, floatBitsToUint(level), broken, dark), bitCount(broken) == kIntervals);
    book(kLedgerOnCasters, entry.flux);
    book(tally);
}
#endif
