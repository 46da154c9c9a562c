// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The nodes of the cloth, two texels each: position [m] and strain, normal and flags.

layout(binding = 0) uniform samplerBuffer nodes;
uniform int cols;

int node_index(int row, int col) {
    return row * cols + col;
}

vec4 position_and_strain(int node) {
    return texelFetch(nodes, 2 * node);
}

vec4 normal_and_flags(int node) {
    return texelFetch(nodes, 2 * node + 1);
}

#ifdef HAS_GAPS
// Whether there is no cell to the lower right of a node.
bool is_gap(int row, int col) {
    return (int(normal_and_flags(node_index(row, col)).w) & FLAG_GAP) != 0;
}
#endif
