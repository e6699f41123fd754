// Fixed-point deposits into the spectral map's pyramid (kBindMap), 2x2 bilinear: the sums are the same whatever the
// order. Expects u_fixedPerFlux, u_xyz and, with BANDS, u_bands and u_glass of photon_trace.

// Which half of the photons this one belongs to, 0 or 1; set it before the first deposit. Luminance is kept apart by
// halves: how much they differ tells how much too few photons cost.
int photonHalf = 0;

// Neighbours on the grid belong to different halves.
int halfOf(ivec2 texel) { return (texel.x ^ texel.y) & 1; }

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

// First texel of a level of the pyramid whose finest level has `size` texels.
int firstTexelOf(int level, ivec2 size) {
    int first = 0;
    for (int i = 0; i < level; ++i) first += (size.x >> i) * (size.y >> i);
    return first;
}

// A level between two of the pyramid's: flux is split between them.
struct Level {
    ivec2 fineSize, coarseSize;
    int fineFirst, coarseFirst;
    float coarseShare;
};

Level levelOf(float level, ivec2 size) {
    int fine = int(level);
    return Level(size >> fine, size >> (fine + 1), firstTexelOf(fine, size), firstTexelOf(fine + 1, size), level - float(fine));
}

// How wide a deposit is, in texels of its level; set it before the first deposit. Where photons land closer together than
// texels lie, a wider one would only blur what they resolve.
float photonWidth = 1.0;
const float kNarrowest = 0.05;
const float kOverlap = 2.0;   // photons wider than they lie apart: neither they nor their beat against the texels show

// Of a square of that width in the four texels it may touch: at 1 they are bilinear.
vec4 shares(vec2 f) {
    f = clamp((f - 0.5) / photonWidth + 0.5, 0.0, 1.0);
    return vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
}

int cornerOf(Place place, int i) { return place.texel + (i & 1) + (i >> 1) * place.width; }

#if BANDS
void deposit(Place place, int k, float flux) {
    vec4 share = shares(place.f) * (flux * u_fixedPerFlux);
    float carry = 0.0;   // what rounding kept back, to the next texel
    for (int i = 0; i < 4; ++i) {
        float whole = max(floor(share[i] + carry + 0.5), 0.0);
        carry += share[i] - whole;
        atomicAdd(map[cornerOf(place, i) * u_bands + int(u_glass[k].w)], uint(whole));
    }
}

void depositAll(vec3 landed[kMostWavelengths], ivec2 size, int firstTexel, float share) {
    for (int k = 0; k < u_wavelengths; ++k) {
        if (landed[k].z * share > 0.0) deposit(placeAt(landed[k].xy, size, firstTexel), k, landed[k].z * share);
    }
}
#else
vec3 photonCarry = vec3(0.0);   // what rounding kept back of this photon's last deposit: its flux stays whole however it is split

void addTo(int texel, vec3 xyz) {
    vec3 whole = max(floor(xyz + photonCarry + 0.5), vec3(0.0));
    photonCarry += xyz - whole;
    uvec3 amount = uvec3(whole);
    int first = texel * kMapWords;
    atomicAdd(map[first + kMapX], amount.x);
    atomicAdd(map[first + kMapEvenY + photonHalf], amount.y);
    atomicAdd(map[first + kMapZ], amount.z);
}

// `amount`: XYZ in fixed-point units.
void deposit(Place place, vec3 amount) {
    vec4 share = shares(place.f);
    for (int i = 0; i < 4; ++i) addTo(cornerOf(place, i), share[i] * amount);
}

void deposit(Place place, int k, float flux) { deposit(place, u_xyz[k].xyz * (flux * u_fixedPerFlux)); }

// Neighbouring wavelengths mostly land in the same texels: a run of them is gathered and written once.
void depositAll(vec3 landed[kMostWavelengths], ivec2 size, int firstTexel, float share) {
    int k = share > 0.0 ? 0 : u_wavelengths;
    while (k < u_wavelengths) {
        Place place = placeAt(landed[k].xy, size, firstTexel);
        vec3 corner0 = vec3(0.0), corner1 = vec3(0.0), corner2 = vec3(0.0), corner3 = vec3(0.0);
        int run = place.texel;
        while (run == place.texel) {
            vec4 part = shares(place.f) * (landed[k].z * share * u_fixedPerFlux);
            vec3 xyz = u_xyz[k].xyz;
            corner0 += part.x * xyz;
            corner1 += part.y * xyz;
            corner2 += part.z * xyz;
            corner3 += part.w * xyz;
            ++k;
            if (k >= u_wavelengths) break;
            place = placeAt(landed[k].xy, size, firstTexel);
        }
        addTo(run, corner0);
        addTo(run + 1, corner1);
        addTo(run + size.x, corner2);
        addTo(run + size.x + 1, corner3);
    }
}
#endif
