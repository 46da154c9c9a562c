// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Contacts of the edges and faces of a node with thin colliders.

struct SurfaceNode {
    vec3 free;      // velocity without contact [m/s], later the displacement out [m]
    int is_listed;  // 1: listed in this substep
    int first;      // entry of its first collider
    int bodies;     // near colliders, one bit each
    int is_held;    // 1: by a row
    float shares;   // sum of the weights of the rows
    int first_row;  // in the list of its rows
    int row_count;
    ivec2 held;     // entry of the list of held nodes: index among the near nodes, and the node
#if HAS_SELF
    vec4 by_rows;   // sum of the impulses of its rows [m/s]
#endif
};

layout(std430, binding = SURFACE_NODES) coherent buffer SurfaceNodes { SurfaceNode surface_nodes[]; };
