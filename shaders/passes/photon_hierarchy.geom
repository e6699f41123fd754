// A cell with some caster in it becomes its four cells one level finer, any other is dropped; at the finest level (LEAF)
// the cells that are left are the photons. Captured by transform feedback.
layout(points) in;
layout(points, max_vertices = 4) out;
flat in uint v_cell[];
layout(xfb_buffer = 0, xfb_offset = 0, xfb_stride = 4) flat out uint o_cell;
uniform sampler2D u_front;       // mipmapped: a level's layer value is above 0 where any below is
uniform int u_level;

void main() {
    uvec2 cell = uvec2(v_cell[0] & 0xffffu, v_cell[0] >> 16);
    if (texelFetch(u_front, ivec2(cell), u_level).w <= 0.0) return;
#if LEAF
    o_cell = v_cell[0];
    EmitVertex();
#else
    for (uint i = 0u; i < 4u; ++i) {
        o_cell = (2u * cell.x + (i & 1u)) | (2u * cell.y + (i >> 1)) << 16;
        EmitVertex();
        EndPrimitive();
    }
#endif
}
