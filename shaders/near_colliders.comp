// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// List the nodes that may come to a collider in an explicit substep that has been made: by a
// sphere around each collider, which is cheap beside what contact.comp does with each of them.

#include "lattice.glsl"
#include "state_in.glsl"
#include "contact.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = VELOCITY_OUT) readonly buffer VelocityOut { vec4 velocity_out[]; };

#include "near_nodes.glsl"

uniform float substep;                     // [s]
uniform float near_limit[COLLIDERS];  // [m] of the distance from the centre, of a node at rest
uniform float near_share[COLLIDERS];  // of that distance, with what the collider turns by

void main() {
    int col = int(gl_GlobalInvocationID.x);
    int row = int(gl_GlobalInvocationID.y);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    int index = node_index(row, col);
    vec4 v = velocity_out[index];
    if (v.w == 0.0) {
        return;
    }
    vec3 x = load_position(index).xyz;
    float way = substep * length(v.xyz);
    float nearest = 1e30;
    for (int collider = 0; collider < COLLIDERS; ++collider) {
        vec3 arm = x - collider_centre[collider];
        float away = near_share[collider] * length(arm);
#if HAS_PLANE
        away = int(collider_shape[collider]) == SHAPE_PLANE
            ? dot(collider_axes[3 * collider + 2], arm) - (length(arm) - away) : away;
#endif
        nearest = min(nearest, away - near_limit[collider]);
    }
    // Written so that what is no number is near.
    if (!(nearest > way)) {
        uint place = atomicAdd(near_count, 1u);
        near_nodes[place] = uint(index);
        atomicMax(near_groups_x, place / NEAR_LOCAL + 1u);
    }
}
