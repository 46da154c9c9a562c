// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Add the solution to the velocity and move the nodes: v+ = v + dv, x+ = x + h v+; or, in a further
// solve of the same step, by what dv adds: x+ = x + h dv.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "state_in.glsl"
#include "state_out.glsl"
#include "low_parts.glsl"
#include "solver/state_index.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float substep;  // [s]
uniform int is_further;
uniform vec3 common_change;  // [m/s] of all nodes, besides the solution

void main() {
    int row = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    int index = state_index(row, col);
    vec4 velocity = load_velocity(index);
    vec4 position = load_position(index);
    vec3 change = load_vector(cloth_entry(SOLUTION, level_index(0, row, col)));
    vec3 before = is_further == 1
        ? load_vector(cloth_entry(CHANGE, level_index(0, row, col))) : vec3(0.0);
    store_vector(cloth_entry(CHANGE, level_index(0, row, col)), before + change);
    change += velocity.w > 0.0 ? common_change : vec3(0.0);
    velocity.xyz = changed_velocity(index, velocity.xyz, change);
    vec3 moved = substep * (is_further == 1 ? change : velocity.xyz);
    velocity_out[index] = velocity;
    position_out[index] = vec4(
        changed_position(index, position.xyz, moved), position.w);
}
