// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The edges of the coarse levels: one tensor for each direction in which edges begin at a node.

#define DIRECTIONS 4  // right, down, down right, down left

const ivec2 TOWARDS[DIRECTIONS] = ivec2[](SHORT_EDGES);

Symmetric load_edge(int which, int index, int direction) {
    vec4 most = load_system(system_entry(which, EDGES + direction, index));
    vec4 rest = load_system(system_entry(which, EDGES + DIRECTIONS + direction / 2, index));
    return Symmetric(most.xyz, vec3(most.w, direction % 2 == 0 ? rest.xy : rest.zw));
}

void store_edges(int which, int index, Symmetric edges[DIRECTIONS]) {
    for (int i = 0; i < DIRECTIONS; ++i) {
        system_data[system_entry(which, EDGES + i, index)] = vec4(edges[i][0], edges[i][1].x);
    }
    for (int i = 0; i < DIRECTIONS; i += 2) {
        system_data[system_entry(which, EDGES + DIRECTIONS + i / 2, index)] =
            vec4(edges[i][1].yz, edges[i + 1][1].yz);
    }
}
