in vec3 v_normalView;
layout(location = 0) out vec4 o_layer;

void main() { o_layer = vec4(normalize(v_normalView), gl_FragCoord.z); }
