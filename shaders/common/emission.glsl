// How much of its on-axis intensity the light sends along a direction of the emission view: cone and cookie.
// Twin of coneFalloff() in server/render/coarse_trace.h.
uniform vec3 u_lightAxis;        // unit, view space
uniform vec2 u_coneCos;          // cosines of the inner and the outer half angle; (-2, -3): no cone
#if COOKIE
uniform sampler2D u_cookie;      // its luminance multiplies the cone; spans the outer cone's square
uniform mat3 u_viewToCookie;     // view-space direction -> cookie plane: xy / z in -1..1 across the outer cone
#endif

float emittedShare(vec3 direction) {
    float c = dot(direction, u_lightAxis);
    float t = u_coneCos.x - u_coneCos.y < 1e-6 ? step(u_coneCos.y, c)
                                               : clamp((c - u_coneCos.y) / (u_coneCos.x - u_coneCos.y), 0.0, 1.0);
    float share = t * t;
#if COOKIE
    vec3 at = u_viewToCookie * direction;
    if (at.z <= 0.0) return 0.0;
    share *= dot(textureLod(u_cookie, 0.5 + 0.5 * at.xy / at.z, 0.0).rgb, vec3(0.2126, 0.7152, 0.0722));
#endif
    return share;
}
