layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
uniform mat4 u_worldToClip;
uniform mat4 u_worldToView;
out vec3 v_normalView;

void main() {
    v_normalView = mat3(u_worldToView) * a_normal;
    gl_Position = u_worldToClip * vec4(a_position, 1.0);
}
