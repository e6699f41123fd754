// Where a ray meets the receivers of a view: clipped to the view, then a bracketed secant (Illinois rule) on
// behindLayer(), which is linear along a ray on any plane.
const int kHit = 0;
const int kLeftView = 1;          // crosses the view's side before it meets anything
const int kNoReceiver = 2;        // ends before nothing
const int kRejected = 3;          // the search did not settle on a surface
const int kMarches = 4;           // samples that look for the first crossing
const float kResidual = 4e-3;     // of the depth: a surface is met within this

// Shrinks [from, to] to where a + t b <= 0.
void clipHalfSpace(float a, float b, inout float from, inout float to) {
    if (abs(b) < 1e-20) {
        if (a > 0.0) to = -1.0;
    } else if (b > 0.0) {
        to = min(to, -a / b);
    } else {
        from = max(from, -a / b);
    }
}

float behindAt(View view, sampler2D layer, vec3 pos, out vec2 uv) {
    uv = viewToUv(view, pos);
    return behindLayer(view, pos, textureLod(layer, uv, 0.0).x);
}

// Where the last ray was met and how fast behindLayer() grows there: where its neighbour starts to look.
struct Meeting {
    float t;
    float slope;      // 1/m; 0: no neighbour yet
};

// Follows the surface that a neighbouring ray met: secant steps from its meeting point, the first with its slope. The
// second makes it exact on a plane however much the ray has turned; one is enough where it hardly turns. False when it
// does not settle on it; the ray must then be searched from its beginning.
bool followReceiver(View view, sampler2D layer, vec3 origin, vec3 direction, const bool twice, inout Meeting near, out vec2 uv) {
    float a = near.t, slope = near.slope;
    float fa = behindAt(view, layer, origin + a * direction, uv);
    float b = a - fa / max(slope, 1e-20);
    float fb = behindAt(view, layer, origin + b * direction, uv);
    if (twice) {
        float turned = (fb - fa) / (b - a);
        bool known = abs(fb) > 1e-5 && turned > 0.0;   // nearer, rounding leaves no slope to be known
        slope = known ? turned : slope;
        b = known ? b - fb / slope : b;
        fb = behindAt(view, layer, origin + b * direction, uv);
    }
    bool inside = all(greaterThanEqual(uv, vec2(0.0))) && all(lessThanEqual(uv, vec2(1.0)));
    bool met = near.slope > 0.0 && inside && b > 0.0 && abs(fb) <= 0.25 * kResidual;
    if (met) near = Meeting(b, slope);
    return met;
}

// `origin` and unit `direction` in the view's space, at most `reach` away; `uv` is where it is met.
int findReceiver(View view, sampler2D layer, vec3 origin, vec3 direction, float reach, int steps, out vec2 uv,
                 out Meeting met) {
    met = Meeting(0.0, 0.0);
    float from = 0.0;
    float to = reach;
    vec2 h = view.halfExtent;
    if (isPerspective(view)) {
        clipHalfSpace(origin.x + h.x * origin.z, direction.x + h.x * direction.z, from, to);
        clipHalfSpace(-origin.x + h.x * origin.z, -direction.x + h.x * direction.z, from, to);
        clipHalfSpace(origin.y + h.y * origin.z, direction.y + h.y * direction.z, from, to);
        clipHalfSpace(-origin.y + h.y * origin.z, -direction.y + h.y * direction.z, from, to);
    } else {
        clipHalfSpace(origin.x - h.x, direction.x, from, to);
        clipHalfSpace(-origin.x - h.x, -direction.x, from, to);
        clipHalfSpace(origin.y - h.y, direction.y, from, to);
        clipHalfSpace(-origin.y - h.y, -direction.y, from, to);
    }
    clipHalfSpace(origin.z + view.near, direction.z, from, to);
    uv = vec2(0.5);
    if (from >= to) return kLeftView;

    float a = from;
    float fa = behindAt(view, layer, origin + a * direction, uv);
    if (fa > kResidual) return from > 0.0 ? kLeftView : kRejected;
    if (fa >= 0.0) return kHit;
    float b = a;
    float fb = fa;
    for (int i = 1; i <= kMarches && fb < 0.0; ++i) {
        a = b;
        fa = fb;
        b = mix(from, to, float(i) / float(kMarches));
        fb = behindAt(view, layer, origin + b * direction, uv);
    }
    if (fb < 0.0) return to < reach ? kLeftView : kNoReceiver;

    float f = fb;
    int side = 0;
    met = Meeting(b, (fb - fa) / (b - a));
    for (int i = 0; i < steps && abs(f) > 1e-6; ++i) {
        float t = b - fb * (b - a) / (fb - fa);
        f = behindAt(view, layer, origin + t * direction, uv);
        met.t = t;
        if (f > 0.0) {
            b = t;
            fb = f;
            if (side == 1) fa *= 0.5;
            side = 1;
        } else {
            a = t;
            fa = f;
            if (side == -1) fb *= 0.5;
            side = -1;
        }
    }
#if RESIDUALS
    countResidual(kResidualReceiver, abs(f) / kResidual);
#endif
    return abs(f) <= kResidual ? kHit : kRejected;
}
