// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Contacts of edges and faces with thin colliders, and the nodes that they act on. A node owns the
// edges to the right and down, the one across its cell, and the two triangles of the cell.

#include "surface_nodes.glsl"

#define SURFACE_EDGES 3
#define SURFACE_ROWS_OF_BODY (SURFACE_EDGES + 2 * SURFACE_TIPS)

// What acts on up to three nodes, with weights that add up to 1.
struct SurfaceRow {
    vec4 normal;    // away from the collider, and the gap [m] less the clearance
    vec4 impulse;   // on the cloth [m/s of a node amid it], and whether there is a contact, 1 or 0
    vec4 weights;   // of the three nodes, and the collider
};

// A row, and some entries of lists, which have as much room as there are rows.
struct SurfacePlace {
    SurfaceRow row;
    uvec2 acting;   // a row that acts: its place and its owner
    uvec2 entry;    // at the first row of an entry: its owner and its collider
    uvec2 of_node[3];  // rows of nodes, one node after another: place, and bits of the weight
    uvec2 spare;
};

layout(std430, binding = SURFACE_ROWS) coherent buffer SurfaceRows {
    uint surface_entries;
    uint surface_lost;      // owners for which there was no room
    uint surface_missed;    // rows with a node that was not listed
    uint acting_rows;
    uint held_nodes;
    uint listed_rows;       // of nodes
    uvec2 surface_spare;
    SurfacePlace surface_rows[];
};

// The offset of the nodes of a row from its owner.
ivec3 surface_offsets(int row) {
    if (row == 0) {
        return ivec3(0, 1, 0);
    }
    if (row == 1) {
        return ivec3(0, PITCH, 0);
    }
    if (row == 2) {
        return ivec3(1, PITCH, 0);
    }
    return row < SURFACE_EDGES + SURFACE_TIPS
        ? ivec3(0, PITCH, 1) : ivec3(1, PITCH, PITCH + 1);
}

int surface_row_count(int row) { return row < SURFACE_EDGES ? 2 : 3; }
