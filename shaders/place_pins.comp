// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Puts pins where they are and gives them their velocities, one an invocation.

layout(local_size_x = PINS_LOCAL) in;

struct Pin {
    vec4 position;  // [m]
    vec3 velocity;  // [m/s]
    int index;      // of the node in the stored lattice
};

layout(std430, binding = POSITION_IN) buffer Position { vec4 position[]; };
layout(std430, binding = VELOCITY_IN) buffer Velocity { vec4 velocity[]; };
layout(std430, binding = MOVED_PINS) readonly buffer MovedPins { Pin pins[]; };

uniform int count;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) {
        return;
    }
    Pin pin = pins[i];
    position[pin.index].xyz = pin.position.xyz;
    velocity[pin.index].xyz = pin.velocity;
}
