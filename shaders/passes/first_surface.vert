layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
uniform mat4 u_worldToClip;
uniform mat4 u_worldToView;
out vec3 v_world, v_normal;
out float v_depth;

void main() {
    v_world = a_position;
    v_normal = a_normal;
    v_depth = -(u_worldToView * vec4(a_position, 1.0)).z;
    gl_Position = u_worldToClip * vec4(a_position, 1.0);
}
