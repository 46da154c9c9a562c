// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The impulses of layers on nodes that a solve of the implicit step is to include, STRIP nodes of a
// column an invocation: those of the last substep, or what rounds have changed since the last solve.

#include "lattice.glsl"
#include "self_contact/head.glsl"
#include "self_contact/contacts.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

// On each node, all that solves have included [m/s of a node amid the cloth].
layout(std430, binding = SELF_APPLIED) buffer SelfApplied { vec4 applied[]; };
// The part that the next one is to include.
layout(std430, binding = SELF_DRIVEN) writeonly buffer SelfDriven { vec4 driven[]; };
layout(binding = VELOCITY_OUT) uniform samplerBuffer velocity_out;

uniform int begins;   // the substep
uniform float share;  // of the impulses of the last substep that it begins with [1]

void main() {
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, STRIP);
    if (first.x >= COLS || first.y >= ROWS) {
        return;
    }
    float largest = 0.0;
    for (int i = 0; i < STRIP && first.y + i < ROWS; ++i) {
        int index = node_index(first.y + i, first.x);
        vec3 before = applied[index].xyz;
        if (begins == 1) {
            applied[index] = driven[index] = vec4(share * before, 0.0);
            continue;
        }
        int sums[3] = self_nodes[index].impulse;
        vec3 now = impulse_unit * vec3(sums[0], sums[1], sums[2]);
        vec3 change = now - before;
        applied[index] = vec4(now, 0.0);
        driven[index] = vec4(change, 0.0);
        largest = max(largest, texelFetch(velocity_out, index).w * length(change));
    }
    if (largest > 0.0) {
        atomicMax(largest_drive, floatBitsToUint(largest));
    }
}
