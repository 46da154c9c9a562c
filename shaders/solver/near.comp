// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// List the nodes that touch a collider, were let go by one, or may come to one at the velocity that
// a solve has led to: few of all, and contact.comp does much with each.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/state_index.glsl"
#include "solver/free_directions.glsl"
#include "solver/near_list.glsl"
#include "state_in.glsl"
#include "collider_bounds.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float substep;        // [s]
uniform float most_unsolved;  // [m] that a node may be moved by without another solve

void main() {
    int row = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    vec4 v = load_velocity(state_index(row, col));
    int index = node_index(row, col);
    bool touches = load_contact(index).w > 0.0
        || load_vector(cloth_entry(GIVEN, index)) != vec3(0.0);
    vec3 begin = load_vector(cloth_entry(BEGIN_POSITION, index));
    // NaN counts as near, so that the node is listed.
    bool is_far = near_bodies(begin, 0.0, substep * length(v.xyz) + most_unsolved) == 0u;
    if (v.w > 0.0 && (touches || !is_far)) {
        uint place = atomicAdd(near_count, 1u);
        near_nodes[place] = uint(row * COLS + col);
        atomicAdd(near_groups_x, place % NEAR_LOCAL == 0u ? 1u : 0u);
    }
}
