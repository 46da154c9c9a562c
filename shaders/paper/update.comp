// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The paper's second pass (Tab. 2): velocity and position of each node from force and mass, in
// place. Pinned nodes keep the velocity of their pin, which the paper leaves out.

#include "lattice.glsl"
#include "applied_acceleration.glsl"
#include "low_parts.glsl"
#if HAS_HELD
#include "held.glsl"
#endif

layout(local_size_x = UPDATE_LOCAL) in;

layout(std430, binding = POSITION_IN) buffer Position { vec4 position[]; };
layout(std430, binding = VELOCITY_IN) buffer Velocity { vec4 velocity[]; };
layout(std430, binding = FORCE) buffer Force { vec4 force[]; };
layout(std430, binding = MASS) readonly buffer Mass { float mass[]; };

uniform float substep;  // [s]

void main() {
    int node = int(gl_GlobalInvocationID.x);
    if (node >= ROWS * COLS) {
        return;
    }
    int i = node_index(node / COLS, node % COLS);
    vec3 a = applied_acceleration(i) + force[i].xyz / mass[i];
    velocity[i].xyz = changed_velocity(i, velocity[i].xyz, velocity[i].w * substep * a);
    position[i].xyz = changed_position(i, position[i].xyz, substep * velocity[i].xyz);
    force[i] = vec4(0.0);
#if HAS_HELD
    if (is_held_by_pin(position[i], velocity[i])) {
        held[held_entry(i)] = vec4(substep * a, substep);
    }
#endif
}
