// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Contacts of edges and faces with thin colliders in an explicit substep, and the nodes that they
// act on.

#include "surface_nodes.glsl"
#include "surface_row.glsl"

// A row, and some entries of lists, which have as much room as there are rows.
struct SurfacePlace {
    SurfaceRow row;
    uvec2 acting;   // a row that acts: its place and its owner
    uvec2 entry;    // at the first row of an entry: its owner and its collider
    uvec2 of_node[3];  // rows of nodes, one node after another: place, and bits of the weight
    uvec2 spare;
#if COLLIDERS > 1
    // Of the collider that the row faces: friction of its surface, and what both press with [m/s].
    vec4 facing;
#endif
};

layout(std430, binding = SURFACE_ROWS) coherent buffer SurfaceRows {
    uint surface_entries;
    uint surface_lost;      // owners for which there was no room
    uint surface_missed;    // rows with a node that was not listed
    uint acting_rows;
    uint held_nodes;
    uint listed_rows;       // of nodes
    uint surface_unsettled;  // substeps whose rounds did not settle
    uint surface_spare;
    uint kept_time;     // substeps until now, modulo 2^32
    float kept_length;  // of the last one in which rows acted [s]; 0: nothing is kept
    uvec2 kept_spare;
    // Impulse of each row when it last acted, without that of the collider that it faces [m/s], and
    // bits of the time: in the next substep, rounds start from there.
    vec4 kept[SURFACE_STORED * THIN_COLLIDERS * SURFACE_ROWS_OF_BODY];
    SurfacePlace surface_rows[];
};

// Where the impulse of a row is kept.
int kept_place(int index, int collider, int row) {
    int rank = bitCount(SURFACE_COLLIDERS & ((1u << uint(collider)) - 1u));
    return (rank * SURFACE_STORED + index) * SURFACE_ROWS_OF_BODY + row;
}
