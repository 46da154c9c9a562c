// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Stiffness tensor of an edge of the cloth, from the entries that right_side.comp has stored.

#include "solver/edge_slots.glsl"

vec4 load_node(ivec2 at) { return load_system(cloth_entry(NODE, node_index(at.x, at.y))); }

// Tensor of the edge between the nodes at and at + by.
Symmetric edge_block(ivec2 at, ivec2 by, int edge) {
    int index = node_index(at.x, at.y);
    vec3 d = load_node(at).xyz - load_node(at + by).xyz;
#if HAS_BEND
    if (edge >= EDGE_TWO_ROW) {
        vec4 weight = load_system(cloth_entry(BEND_WEIGHT, index));
        int line = LONG_SLOT(edge);
        return weight[line] * outer_square(d) + scaled_identity(weight[line + 2]);
    }
#endif
    int line = SHORT_SLOT(edge);
    return load_system(cloth_entry(ALONG, index))[line] * outer_square(d)
        + scaled_identity(load_system(cloth_entry(ACROSS, index))[line]);
}

// The two edges that lie along by at a node: the one that begins there and the one that ends.
Symmetric edge_blocks(ivec2 at, ivec2 by, int edge) {
    return edge_block(at, by, edge) + edge_block(at - by, by, edge);
}
