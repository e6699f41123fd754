// A cell of the level that the traversal has come to: x | y << 16. START: the cells of the coarsest level, all of them.
#if START
uniform uint u_side;
#else
layout(location = 0) in uint a_cell;
#endif
flat out uint v_cell;

void main() {
#if START
    uint i = uint(gl_VertexID);
    v_cell = i % u_side | (i / u_side) << 16;
#else
    v_cell = a_cell;
#endif
}
