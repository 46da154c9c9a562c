// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// End a substep of the paper's adaptive scheme, whose velocities the sweeps have settled: move the
// nodes. With HAS_HELD, add to what pinned ones are driven with what the sweeps have pulled them
// with.

#include "lattice.glsl"
#include "state_in.glsl"
#include "low_parts.glsl"
#if HAS_HELD
#include "spring_law.glsl"
#include "held.glsl"
#endif

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = POSITION_OUT) writeonly buffer PositionOut { vec4 position_out[]; };
layout(std430, binding = VELOCITY_OUT) readonly buffer Velocity { vec4 velocity_out[]; };
#if HAS_HELD
layout(std430, binding = TENSION) readonly buffer Tension { vec4 tension_in[]; };
#endif

uniform float substep;  // [s]
#if HAS_HELD
uniform float kick;          // [s] what tensions act for
uniform float inverse_mass;  // [1/kg]

// The pull of an edge on the node at from, where one of its ends is free.
vec3 pull(int from, int to, float tension) {
    vec3 d = load_position(to).xyz - load_position(from).xyz;
    return load_velocity(to).w * tension * length_and_inverse(d).y * d;
}
#endif

void main() {
    int col = int(gl_GlobalInvocationID.x);
    int row = int(gl_GlobalInvocationID.y);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    int index = node_index(row, col);
    vec4 x = load_position(index);
    position_out[index] = vec4(
        changed_position(index, x.xyz, substep * velocity_out[index].xyz), x.w);
#if HAS_HELD
    if (is_held_by_pin(x, load_velocity(index))) {
        // Ghosts have no tension, and no part.
        vec4 here = tension_in[index];
        vec3 total = vec3(0.0);
#if HAS_STRUCTURAL
        total += pull(index, index + 1, here[EDGE_ROW]);
        total += pull(index, index - 1, tension_in[index - 1][EDGE_ROW]);
        total += pull(index, index + PITCH, here[EDGE_COLUMN]);
        total += pull(index, index - PITCH, tension_in[index - PITCH][EDGE_COLUMN]);
#endif
#if HAS_SHEAR
        int left = index - 1, above = index - PITCH;
        total += pull(index, index + PITCH + 1, here[EDGE_DIAGONAL]);
        total += pull(index, above - 1, tension_in[above - 1][EDGE_DIAGONAL]);
        total += pull(index, left + PITCH, tension_in[left][EDGE_CROSSING]);
        total += pull(index, above + 1, tension_in[above][EDGE_CROSSING]);
#endif
        held[held_entry(index)].xyz += kick * inverse_mass * total;
    }
#endif
}
