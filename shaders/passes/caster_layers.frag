in vec3 v_normalView;
layout(location = 0) out vec4 o_layer;

void main() {
    // Normals that cancel out between two corners: the surface then faces the view, or away from it.
    float length2 = dot(v_normalView, v_normalView);
    vec3 facing = vec3(0.0, 0.0, gl_FrontFacing ? 1.0 : -1.0);
    o_layer = vec4(length2 > 1e-12 ? v_normalView * inversesqrt(length2) : facing, gl_FragCoord.z);
}
