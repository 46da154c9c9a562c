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
