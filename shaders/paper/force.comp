// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The paper's first pass (Tab. 1): the spring forces on each node, kept in a buffer of their own.
// A baseline for benchmarks, as the paper has it: 12 neighbours, each checked against the border,
// read from storage blocks. mass_spring_step.comp is the layout that is used.

#include "lattice.glsl"
#include "state_in.glsl"
#include "spring_law.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = FORCE) writeonly buffer Force { vec4 force_out[]; };

vec3 compute_force(int row, int col, int drow, int dcol, int rest) {
    ivec2 there = ivec2(row + drow, col + dcol);
    if (there.x < 0 || there.x >= ROWS || there.y < 0 || there.y >= COLS) {
        return vec3(0.0);
    }
    int i = node_index(row, col);
    int j = node_index(there.x, there.y);
    return spring_force(
        load_position(j).xyz - load_position(i).xyz, load_velocity(j).xyz - load_velocity(i).xyz,
        1.0, rest);
}

vec3 both_ways(int row, int col, int drow, int dcol, int rest) {
    return compute_force(row, col, drow, dcol, rest)
        + compute_force(row, col, -drow, -dcol, rest);
}

#if HAS_RIGIDITY
#include "bending.glsl"

uniform float bending[2];  // [N/m] along a row, along a column

vec3 bent(int row, int col, int drow, int dcol) {
    vec4 behind = load_position(node_index(row - drow, col - dcol));
    vec4 here = load_position(node_index(row, col));
    vec4 ahead = load_position(node_index(row + drow, col + dcol));
    return second_difference(behind.w * here.w * ahead.w, behind.xyz, here.xyz, ahead.xyz);
}

vec3 bending_along(int row, int col, int drow, int dcol) {
    return unbent(
        bent(row - drow, col - dcol, drow, dcol), bent(row, col, drow, dcol),
        bent(row + drow, col + dcol, drow, dcol));
}
#endif

#if HAS_BENDING_DAMPING
#include "bending_damping.glsl"

uniform float bending_damping;  // [s]
#endif

#define ADD_BOTH_WAYS(FORCE, EDGE, DROW, DCOL, FAMILY, REST) \
    FORCE += both_ways(row, col, DROW, DCOL, REST);

void main() {
    int row = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    vec3 force = vec3(0.0);
    EACH_EDGE(ADD_BOTH_WAYS, force)
#if HAS_RIGIDITY
    force -= bending[0] * bending_along(row, col, 0, 1)
        + bending[1] * bending_along(row, col, 1, 0);
#endif
#if HAS_BENDING_DAMPING
    int here = node_index(row, col);
    force -= bending_damping * (
        bending[0] * BENDING_BRAKE(here, 1) + bending[1] * BENDING_BRAKE(here, PITCH));
#endif
    force_out[node_index(row, col)] = vec4(force, 0.0);
}
