// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The levels of the solver in two buffers. Level 0 is the cloth; each further one has half the
// nodes along each side, rounded up. A level is stored like the cloth, with two ghosts around,
// one field after the other. All fields of a ghost are zero for good. The fields and their numbers
// are in sim/solver/solver_fields.py.

#include "lattice.glsl"

uniform ivec4 level_shape[MOST_LEVELS];  // rows, cols, entries in a stored row, entries in all
uniform ivec2 level_begin[MOST_LEVELS];  // where its vectors begin, where its system begins
#ifdef LEVEL_VARIES
int level;
#else
uniform int level;
#endif

int level_index(int which, int row, int col) {
    return (row + HALO) * level_shape[which].z + col + HALO;
}

int vector_entry(int which, int field, int index) {
    return level_begin[which].x + field * level_shape[which].w + index;
}

int system_entry(int which, int field, int index) {
    return level_begin[which].y + field * level_shape[which].w + index;
}

// On the cloth, which comes first in both buffers.
int cloth_entry(int field, int index) { return field * STORED + index; }

bool inside(int which, int row, int col) {
    return row < level_shape[which].x && col < level_shape[which].y;
}
