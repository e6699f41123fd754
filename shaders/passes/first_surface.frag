// What a pixel's middle sees first: receiver or caster, before anything is refracted.
in vec3 v_world, v_normal;
in float v_depth;
uniform float u_label;   // 0 for a receiver
layout(location = 0) out vec4 o_surface;
layout(location = 1) out float o_label;

void main() {
    // Normals that cancel out between two corners: the triangle's own, which faces the eye.
    float length2 = dot(v_normal, v_normal);
    vec3 normal = gl_FrontFacing ? v_normal : -v_normal;
    normal = length2 > 1e-12 ? normal * inversesqrt(length2) : normalize(cross(dFdx(v_world), dFdy(v_world)));
    o_surface = vec4(normal, v_depth);
    o_label = u_label;
}
