// How much of its on-axis intensity the light sends along a direction of the emission view: cone and cookie.
// Twin of coneFalloff() in server/render/coarse_trace.h.
uniform vec3 u_lightAxis;        // unit, view space
uniform vec2 u_coneVersine;      // 1 - cosine of the inner and the outer half angle; (3, 4): no cone
#if COOKIE
uniform sampler2D u_cookie;      // its luminance multiplies the cone; spans the outer cone's square
uniform mat3 u_viewToCookie;     // view-space direction -> cookie plane: xy / z in -1..1 across the outer cone
#endif

float emittedShare(vec3 direction) {
    // 1 - cosine, not as a difference of two numbers near 1: cones of a hundredth of a degree keep their shape.
    vec3 off = direction - u_lightAxis;
    float v = 0.5 * dot(off, off), ramp = u_coneVersine.y - u_coneVersine.x;
    float t = ramp <= 1e-6 * u_coneVersine.y ? step(v, u_coneVersine.y) : clamp((u_coneVersine.y - v) / ramp, 0.0, 1.0);
    float share = t * t;
#if COOKIE
    vec3 at = u_viewToCookie * direction;
    if (at.z <= 0.0) return 0.0;
    share *= dot(textureLod(u_cookie, 0.5 + 0.5 * at.xy / at.z, 0.0).rgb, vec3(0.2126, 0.7152, 0.0722));
#endif
    return share;
}
