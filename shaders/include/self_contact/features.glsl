// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The features of the surface of the cloth that can touch each other. A node owns itself, the edges
// to the right, down and across its cell, and the two triangles of the cell. Edges without a triangle
// have no surface.

#define RIGHT 1
#define DOWN 2
#define ACROSS 3

// Bits of what a node owns.
#define OWNS_RIGHT 1u
#define OWNS_DOWN 2u
#define OWNS_CELL 4u
#define OWNS_NODE 8u

layout(binding = SELF_FEATURES) uniform samplerBuffer feature_texels;

// What a node owns; software reads texels much faster than numbers.
uint owned(int index) { return floatBitsToUint(texelFetch(feature_texels, index >> 2)[index & 3]); }

bool has_cell(int index) { return (owned(index) & OWNS_CELL) != 0u; }

// The ends of an edge, which is 4 times the index of its owner plus its kind.
ivec2 edge_nodes(int feature) {
    int kind = feature & 3;
    return (feature >> 2) + (kind == RIGHT ? ivec2(0, 1)
        : kind == DOWN ? ivec2(0, PITCH) : ivec2(1, PITCH));
}

// The corners of a triangle, which is 2 times the index of its owner plus 0 or 1.
ivec3 face_nodes(int face) {
    return (face >> 1) + ((face & 1) == 0 ? ivec3(0, PITCH, 1) : ivec3(1, PITCH, PITCH + 1));
}
