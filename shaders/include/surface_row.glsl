// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Contact of an edge or a face with a thin collider. A node owns the edges to the right and down,
// the one across its cell, and the two triangles of the cell. PRESSED_ROWS 2: and the pressure of
// two colliders on these triangles (surface_pressing.glsl).

#ifndef PRESSED_ROWS
#define PRESSED_ROWS 0
#endif
#define SURFACE_EDGES 3
#define FIRST_PRESSED (SURFACE_EDGES + 2 * SURFACE_TIPS)
#define SURFACE_ROWS_OF_BODY (FIRST_PRESSED + PRESSED_ROWS)

// A contact of up to three nodes, with weights that add up to 1.
struct SurfaceRow {
    vec4 normal;    // away from the collider; w: the gap less the clearance [m]
    // Impulse on the cloth [m/s of an inner node]; w: 0 for no contact, 1 for a contact, 2 + the
    // number of the facing collider for a contact between two.
    vec4 impulse;
    vec4 weights;   // of the three nodes; w: the collider
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
    return row < SURFACE_EDGES + SURFACE_TIPS || row == FIRST_PRESSED
        ? ivec3(0, PITCH, 1) : ivec3(1, PITCH, PITCH + 1);
}

int surface_row_count(int row) { return row < SURFACE_EDGES ? 2 : 3; }
