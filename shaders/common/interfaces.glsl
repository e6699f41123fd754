// What happens to light at an exact surface: which media meet there, Snell and Fresnel, mirrors. Expects surfaces.glsl and
// optics.glsl.

// The casters that a ray is in. Where several overlap, the one of highest priority is what is there: caster numbers are in
// order of priority (Schmidt and Budge 2002, Simple Nested Dielectrics in Ray Traced Images).
struct Inside {
    ivec4 casters;
};
const int kOutside = 0x7fffffff;   // an empty place

Inside outsideAll() { return Inside(ivec4(kOutside)); }

// Number of the caster whose medium it is; kOutside: none.
int mediumOf(Inside inside) {
    ivec2 least = min(inside.casters.xy, inside.casters.zw);
    return min(least.x, least.y);
}

Inside left(Inside inside, int caster) {
    return Inside(mix(inside.casters, ivec4(kOutside), equal(inside.casters, ivec4(caster))));
}

// Of more than four that overlap, the lowest priority is forgotten.
Inside entered(Inside inside, int caster) {
    ivec4 c = left(inside, caster).casters;
    int last = max(max(c.x, c.y), max(c.z, c.w));
    if (c.x == last) c.x = caster;
    else if (c.y == last) c.y = caster;
    else if (c.z == last) c.z = caster;
    else c.w = caster;
    return Inside(c);
}

// Index, absorption (1/m), reflectance of a mirror at normal incidence (-1: glass), of each caster at each entry of the
// spectral table; the colour and luminance that an entry carries.
uniform samplerBuffer u_glasses, u_colours;
uniform int u_casters;
uniform float u_outsideIndex;

vec4 glassAt(int entry, int caster) { return texelFetch(u_glasses, entry * u_casters + caster); }
float indexOf(int entry, int medium) { return medium == kOutside ? u_outsideIndex : glassAt(entry, medium).x; }
float absorptionOf(int entry, int medium) { return medium == kOutside ? 0.0 : glassAt(entry, medium).y; }

struct Crossing {
    bool straight;         // the same medium on both sides: the ray goes on as it came
    bool mirror;           // what is not reflected is absorbed
    float reflectance;
    vec3 reflected, transmitted;
    Inside beyond;         // of what is transmitted; what is reflected stays where it was
};

// Snell and Fresnel for unit `direction` at a normal against it, from index ratio `eta` = n_i / n_t.
Crossing splitAt(vec3 direction, vec3 against, float eta, Inside beyond) {
    Crossing c;
    c.straight = c.mirror = false;
    c.beyond = beyond;
    refractDielectric(direction, against, eta, c.transmitted, c.reflectance);
    c.reflected = reflect(direction, against);
    return c;
}

// Directions follow the interpolated normal; one that it would send to the wrong side of the surface follows the
// surface's own.
Crossing crossingAt(Surface surface, vec3 direction, Inside inside, int entry) {
    float side = dot(direction, surface.geometric) < 0.0 ? 1.0 : -1.0;   // 1: into the caster
    vec3 shading = side * surface.shading, geometric = side * surface.geometric;
    float mirrorR = glassAt(entry, surface.caster).z;
    if (mirrorR >= 0.0) {
        Crossing c = splitAt(direction, shading, 1.0, inside);
        if (dot(c.reflected, geometric) <= 0.0 || dot(direction, shading) >= 0.0) {
            shading = geometric;
            c.reflected = reflect(direction, geometric);
        }
        float m = 1.0 - clamp(-dot(direction, shading), 0.0, 1.0);
        c.reflectance = mirrorR + (1.0 - mirrorR) * m * m * m * m * m;   // Schlick 1994, An Inexpensive BRDF Model
        c.mirror = true;
        return c;
    }
    // What leaves a caster was in it, whether or not its way in was seen.
    Inside before = side > 0.0 ? left(inside, surface.caster) : entered(inside, surface.caster);
    Inside beyond = side > 0.0 ? entered(inside, surface.caster) : left(inside, surface.caster);
    int from = mediumOf(before), into = mediumOf(beyond);
    float nFrom = indexOf(entry, from), nInto = indexOf(entry, into);
    Crossing c = splitAt(direction, shading, nFrom / nInto, beyond);
    bool astray = dot(direction, shading) >= 0.0 || dot(c.reflected, geometric) <= 0.0 ||
                  (c.reflectance < 1.0 && dot(c.transmitted, geometric) >= 0.0);
    if (astray) c = splitAt(direction, geometric, nFrom / nInto, beyond);
    c.straight = from == into;
    return c;
}
