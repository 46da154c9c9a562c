// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Add the forces of thin colliders on edges and faces of pinned nodes to the forces on the pins, after
// surface_contact.comp: one workgroup.

#include "lattice.glsl"
#include "state_in.glsl"
#include "surface_rows.glsl"
#include "held.glsl"

layout(local_size_x = SURFACE_LOCAL) in;

void main() {
    for (uint i = gl_LocalInvocationID.x; i < held_nodes; i += SURFACE_LOCAL) {
        int index = surface_nodes[i].held.y;
        if (!is_held_by_pin(load_position(index), load_velocity(index))) {
            continue;
        }
        vec3 sum = vec3(0.0);
        int first = surface_nodes[index].first_row;
        for (int row = first; row < first + surface_nodes[index].row_count; ++row) {
            uvec2 found = surface_rows[row / 3].of_node[row % 3];
            sum += uintBitsToFloat(found.y) * surface_rows[found.x].row.impulse.xyz;
        }
        held[held_entry(index)].xyz += sum;
    }
}
