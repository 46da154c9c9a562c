// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The lattice with its halo: two ghost nodes on each side, so that no neighbour needs a branch.
// Its size is a uniform, so that a program serves every size.

#include "read_first.glsl"

#define HALO 2

uniform ivec4 lattice;  // rows and columns of nodes, entries in a stored row, entries in all
ivec4 sizes = READ_FIRST(lattice);

#define ROWS sizes.x
#define COLS sizes.y
#define PITCH sizes.z
#define STORED sizes.w

int node_index(int row, int col) {
    return (row + HALO) * PITCH + col + HALO;
}
