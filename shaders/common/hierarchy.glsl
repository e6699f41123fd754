// Nearest triangle along a ray, through a hierarchy of boxes that needs no stack (server/render/bvh.h): a node that is
// missed says where to go on, so a ray looks at each node once at most and always ends.

struct Hierarchy { int nodes; vec3 low; vec3 cellsPerM; };   // grid of the boxes

struct Met { float t; int triangle; float number; };         // triangle -1: none; number: of the caster or the object, or kLost

const ivec4 kAnywhere = ivec4(-2);        // not known what the ray is in: every side of a surface counts
const int kLost = -2;                     // instead of a caster or object: the driver ended the walk before its end
const uint kLeaf = 0x80000000u;
const float kSlack = 1.0000004;           // Ize 2013, Robust BVH Ray Traversal: the roundings of a box's distances

// What a ray is to a triangle, Woop, Benthin & Wald 2013, Watertight Ray/Triangle Intersection: axes turned so that the
// ray runs mostly along z, sheared so that it runs along z alone.
struct Sheared { int longest; vec3 shear; };

vec3 turned(int longest, vec3 v) { return longest == 2 ? v : longest == 1 ? v.zxy : v.yzx; }

Sheared shearedAlong(vec3 direction) {
    vec3 size = abs(direction);
    int longest = size.z >= size.x && size.z >= size.y ? 2 : size.y >= size.x ? 1 : 0;
    vec3 d = turned(longest, direction);
    return Sheared(longest, vec3(d.xy, 1.0) / d.z);
}

// Edges that two triangles share give both the same number with opposite signs, so no ray passes between them.
bool meetTriangle(Sheared ray, vec3 a, vec3 b, vec3 c, out float t, out float determinant) {
    a = turned(ray.longest, a);
    b = turned(ray.longest, b);
    c = turned(ray.longest, c);
    precise vec2 a2 = a.xy - ray.shear.xy * a.z, b2 = b.xy - ray.shear.xy * b.z, c2 = c.xy - ray.shear.xy * c.z;
    precise float u = c2.x * b2.y - c2.y * b2.x, v = a2.x * c2.y - a2.y * c2.x, w = b2.x * a2.y - b2.y * a2.x;
    determinant = u + v + w;
    t = ray.shear.z * (u * a.z + v * b.z + w * c.z) / determinant;
    float low = min(u, min(v, w)), high = max(u, max(v, w));
    return (low >= 0.0 || high <= 0.0) && determinant != 0.0;
}

// Narrows `met` to the nearest triangle beyond `least` (a little below 0 for what the ray starts on). Fronts of what the
// ray is in already and backs of what it is not in are passed, and so is triangle `from`.
void meetHierarchy(usamplerBuffer nodes, samplerBuffer corners, Hierarchy hierarchy, vec3 origin, vec3 direction, float least,
                   int from, ivec4 inside, inout Met met) {
    vec3 way = mix(max(direction, vec3(1e-20)), min(direction, vec3(-1e-20)), lessThan(direction, vec3(0.0)));
    vec3 start = (origin - hierarchy.low) * hierarchy.cellsPerM + 1.0, perCell = 1.0 / (way * hierarchy.cellsPerM);
    Sheared ray = shearedAlong(direction);

    int node = 0, triangle = 0, end = 0;
    while (node < hierarchy.nodes) {
        // Boxes up to a leaf
        bool found = false;
        uint link = 0u;
        while (!found && node < hierarchy.nodes) {
            uvec4 box = texelFetch(nodes, node);
            vec3 low = (vec3(ivec3(box.xyz & 0xffffu)) - start) * perCell, high = (vec3(ivec3(box.xyz >> 16)) - start) * perCell;
            vec3 enters = min(low, high), leaves = max(low, high);
            float last = min(min(leaves.x, leaves.y), min(leaves.z, met.t));
            bool meets = max(max(enters.x, enters.y), max(enters.z, least)) <= last * kSlack;
            bool leaf = (box.w & kLeaf) != 0u;
            found = meets && leaf;
            link = box.w;
            node = meets || leaf ? node + 1 : int(box.w);
        }

        // Its triangles
        triangle = int((link & ~kLeaf) >> 3);
        end = found ? triangle + int(link & 7u) + 1 : 0;
        for (; triangle < end; ++triangle) {
            vec4 a = texelFetch(corners, 3 * triangle), b = texelFetch(corners, 3 * triangle + 1), c = texelFetch(corners, 3 * triangle + 2);
            float t, determinant;
            bool hit = meetTriangle(ray, a.xyz - origin, b.xyz - origin, c.xyz - origin, t, determinant);
            bool within = any(equal(inside, ivec4(int(a.w))));
            bool front = determinant * ray.shear.z > 0.0;
            if (hit && t > least && t < met.t && triangle != from && (front != within || inside == kAnywhere)) met = Met(t, triangle, a.w);
        }
    }

    // Mesa's software renderer ends all loops after 65,535 turns, of all loops of an invocation together.
    if (node < hierarchy.nodes || triangle < end) met = Met(met.t, -1, float(kLost));
}
