// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The first pass of a substep of the paper's adaptive scheme: springs within the limit and all else
// that acts change the velocities. Springs beyond the limit give no force: sweep.comp holds them.
// HAS_HELD 1: the pass records what pinned nodes are driven with.

#include "lattice.glsl"
#include "state_in.glsl"
#include "state_out.glsl"
#include "spring_law.glsl"
#include "strain_limit.glsl"
#include "applied_acceleration.glsl"
#include "symplectic_euler.glsl"
#if HAS_RIGIDITY
#include "bending.glsl"

uniform float bending[2];  // [N/m] along a row, along a column
#endif
#if HAS_BENDING_DAMPING
#include "bending_damping.glsl"

uniform float bending_damping;  // [s]
#endif
#if HAS_HELD
#include "held.glsl"
#endif

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

// Force of the spring from here to there on the node here [N].
vec3 spring_within_limit(int here, int there, int family, int rest) {
    vec4 from = load_position(here);
    vec4 to = load_position(there);
#if HAS_DAMPING
    vec3 dv = load_velocity(there).xyz - load_velocity(here).xyz;
#else
    vec3 dv = vec3(0.0);
#endif
    vec3 d = to.xyz - from.xyz;
    vec3 f = spring_force(d, dv, from.w * to.w, rest);
    if (family != BEND) {
        f *= is_beyond_limit(length_and_inverse(d).x, rest_length[rest]) ? 0.0 : 1.0;
    }
    return f;
}

#define ADD_BOTH_WAYS(HERE, EDGE, DROW, DCOL, FAMILY, REST) \
    force -= spring_within_limit(HERE - DROW * PITCH - DCOL, HERE, FAMILY, REST); \
    force += spring_within_limit(HERE, HERE + DROW * PITCH + DCOL, FAMILY, REST);

#if HAS_RIGIDITY
vec3 bent_at(int index, int stride) {
    vec4 behind = load_position(index - stride);
    vec4 here = load_position(index);
    vec4 ahead = load_position(index + stride);
    return second_difference(behind.w * here.w * ahead.w, behind.xyz, here.xyz, ahead.xyz);
}

vec3 unbent_at(int index, int stride) {
    return unbent(
        bent_at(index - stride, stride), bent_at(index, stride), bent_at(index + stride, stride));
}
#endif

void main() {
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * BLOCK;
    if (first.x >= COLS || first.y >= ROWS) {
        return;
    }
    for (int row = first.y; row < first.y + BLOCK; ++row) {
        for (int col = first.x; col < first.x + BLOCK; ++col) {
            int here = node_index(row, col);
            vec3 force = vec3(0.0);
            EACH_EDGE(ADD_BOTH_WAYS, here)
#if HAS_RIGIDITY
            force -= bending[0] * unbent_at(here, 1) + bending[1] * unbent_at(here, PITCH);
#endif
#if HAS_BENDING_DAMPING
            force -= bending_damping * (
                bending[0] * BENDING_BRAKE(here, 1) + bending[1] * BENDING_BRAKE(here, PITCH));
#endif
            vec4 v = load_velocity(here);
            vec3 applied = applied_acceleration(here);
            velocity_out[here].xyz = next_velocity(here, v, force, applied);
#if HAS_HELD
            if (is_held_by_pin(load_position(here), v)) {
                held[held_entry(here)] = vec4(
                    kick * (applied + inverse_mass * force), kick);
            }
#endif
        }
    }
}
