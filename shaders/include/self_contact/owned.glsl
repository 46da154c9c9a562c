// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The features that a node owns, with where they are.

// What a node owns, and the corners of its cell.
struct Owned {
    int index;
    uint features;
    vec3 corner[4];  // at the node, to the right, down, and across
};

Owned owned_by(int index) {
    return Owned(index, owned(index), vec3[4](
        load_position(index).xyz, load_position(index + 1).xyz,
        load_position(index + PITCH).xyz, load_position(index + PITCH + 1).xyz));
}

// Corners of a cell that an edge ends at.
ivec2 edge_corners(int kind) {
    return kind == RIGHT ? ivec2(0, 1) : kind == DOWN ? ivec2(0, 2) : ivec2(1, 2);
}

bool owns_edge(Owned part, int kind) {
    return (part.features & (kind == RIGHT ? OWNS_RIGHT : kind == DOWN ? OWNS_DOWN : OWNS_CELL)) != 0u;
}
