// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Contacts of edges and faces with thin colliders in an explicit substep, and their nodes.

#define PRESSED_ROWS (COLLIDERS > 1 ? 2 : 0)
#include "surface_nodes.glsl"
#include "surface_row.glsl"

// A row, and one entry of each list, whose length is at most the number of rows.
struct SurfacePlace {
    SurfaceRow row;
    uvec2 acting;   // list of acting rows: place and owner
    uvec2 entry;    // at the first row of an entry: owner and collider
    uvec2 of_node[3];  // rows of each node, node after node: place, and bits of the weight
    uvec2 spare;
#if COLLIDERS > 1
    // Friction of the facing collider [1], and change of velocity by the pressure of both [m/s].
    vec4 facing;
#endif
};

layout(std430, binding = SURFACE_ROWS) coherent buffer SurfaceRows {
    uint surface_entries;
    uint surface_lost;      // owners that did not fit into the buffer
    uint surface_missed;    // rows with a node that was not listed
    uint acting_rows;
    uint held_nodes;
    uint listed_rows;       // of nodes
    uint surface_unsettled;  // substeps whose iteration did not converge
    uint surface_spare;
    uint kept_time;     // substeps until now, modulo 2^32
    float kept_length;  // length of the last substep with acting rows [s]; 0: nothing is kept
    uvec2 kept_spare;
    // Impulse of each row when it last acted, without that of the facing collider except where both
    // press [m/s], and bits of the time: the iteration of the next substep starts from it.
    vec4 kept[SURFACE_STORED * THIN_COLLIDERS * SURFACE_ROWS_OF_BODY];
    SurfacePlace surface_rows[];
};

// Index of the kept impulse of a row.
int kept_place(int index, int collider, int row) {
    int rank = bitCount(SURFACE_COLLIDERS & ((1u << uint(collider)) - 1u));
    return (rank * SURFACE_STORED + index) * SURFACE_ROWS_OF_BODY + row;
}
