#include "common/view.glsl"
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec2 a_uv;
uniform mat4 u_worldToClip;
uniform View u_shadowView, u_mapView;
out vec3 v_world, v_normal;
#if TEXTURE
out vec2 v_uv;
#endif
#if SHADOW
out vec3 v_shadow;
#endif
#if MAP
out vec3 v_map;
#endif

void main() {
    vec4 world = vec4(a_position, 1.0);
    v_world = a_position;
    v_normal = a_normal;
#if TEXTURE
    v_uv = a_uv;
#endif
#if SHADOW
    v_shadow = (u_shadowView.worldToView * world).xyz;
#endif
#if MAP
    v_map = (u_mapView.worldToView * world).xyz;
#endif
    gl_Position = u_worldToClip * world;
}
