// DRAWN: the front of the only caster; else every pixel.
#if DRAWN
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
uniform mat4 u_worldToClip;
out vec3 v_world, v_normal;

void main() {
    v_world = a_position;
    v_normal = a_normal;
    gl_Position = u_worldToClip * vec4(a_position, 1.0);
}
#else
void main() { gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0); }
#endif
