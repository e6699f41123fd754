layout(location = 0) in vec3 a_position;
uniform mat4 u_worldToClip;

void main() { gl_Position = u_worldToClip * vec4(a_position, 1.0); }
