// The work is the geometry shader's.
layout(location = 0) in uint a_cell;      // x | y << 16 in the front layer
flat out uint v_cell;

void main() { v_cell = a_cell; }
