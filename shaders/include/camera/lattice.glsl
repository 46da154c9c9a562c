// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The nodes of a cloth where the simulation has them, or a copy of a snapshot in that form.

layout(binding = 0) uniform samplerBuffer positions;  // x y z [m], and 0 where there is no node
uniform ivec4 lattice;  // rows, columns, entries from row to row, entry of the first node
#ifdef HAS_GAPS
layout(binding = 1) uniform samplerBuffer cells;      // 1 where there is one to the lower right
#endif

vec4 node_at(int row, int col) {
    return texelFetch(positions, lattice.w + row * lattice.z + col);
}

#ifdef HAS_GAPS
bool is_gap(int row, int col) {
    int number = row * lattice.y + col;
    return texelFetch(cells, number / 4)[number % 4] == 0.0;
}
#endif

vec3 neighbour(vec3 here, int row, int col) {
    if (row < 0 || col < 0 || row >= lattice.x || col >= lattice.y) {
        return here;
    }
    vec4 there = node_at(row, col);
    return there.w == 0.0 ? here : there.xyz;
}

// Unit normal by central differences, one-sided at a border; up where the cloth has no area.
vec3 node_normal(vec3 here, int row, int col) {
    vec3 down = neighbour(here, row + 1, col) - neighbour(here, row - 1, col);
    vec3 along = neighbour(here, row, col + 1) - neighbour(here, row, col - 1);
    vec3 normal = cross(down, along);
    float size = length(normal);
    return size > 0.0 ? normal / size : vec3(0.0, 0.0, 1.0);
}
