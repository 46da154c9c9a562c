// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// List the nodes with contacts, neighbours side by side, each with room for its entries: STRIP nodes
// of a column an invocation.

#include "lattice.glsl"
#include "self_contact/head.glsl"
#include "self_contact/contacts.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

void main() {
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, STRIP);
    if (first.x >= COLS || first.y >= ROWS) {
        return;
    }
    for (int i = 0; i < STRIP && first.y + i < ROWS; ++i) {
        int index = node_index(first.y + i, first.x);
        uint contacts = self_nodes[index].contacts;
        if (contacts > 0u) {
            uint place = atomicAdd(self_node_count, 1u);
            self_nodes[place].listed = uint(index);
            atomicAdd(node_groups[0], place % SELF_LOCAL == 0u ? 1u : 0u);
            self_nodes[index].first = atomicAdd(entry_count, (contacts + 1u) / 2u);
        }
    }
}
