// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Nodes that contact.comp decides about, in no order, with the workgroups for them.

#define NEAR_LOCAL 32u

layout(std430, binding = SOLVER_NEAR) buffer NearList {
    uint near_groups_x;
    uint near_groups_y;
    uint near_groups_z;
    uint near_count;
    uint near_nodes[];  // row * COLS + col
};

// Column and row of a listed node.
ivec2 near_node(uint place) {
    int listed = int(near_nodes[place]);
    return ivec2(listed % COLS, listed / COLS);
}
