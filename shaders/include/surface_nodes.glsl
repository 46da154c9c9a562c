// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// What a node has of the contacts of its edges and faces with thin colliders.

struct SurfaceNode {
    vec3 free;      // velocity without contact [m/s], later the way out [m]
    int is_listed;  // in this substep
    int first;      // entry of its first collider
    int bodies;     // as bits
    int is_held;    // by a row
    float shares;   // sum of the weights of the rows
    int first_row;  // in the list of its rows
    int row_count;
    ivec2 held;     // of the list of held nodes: its place among the near ones, and the node
#if HAS_SELF
    vec4 by_rows;   // sum of their impulses [m/s]
#endif
};

layout(std430, binding = SURFACE_NODES) coherent buffer SurfaceNodes { SurfaceNode surface_nodes[]; };
