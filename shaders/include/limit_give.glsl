// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Give the impulses of the limits to a node, in the state that the springs have written.

#include "low_parts.glsl"
#include "limit_contact.glsl"
#include "held.glsl"

layout(std430, binding = POSITION_OUT) buffer PositionOut { vec4 position_out[]; };
layout(std430, binding = VELOCITY_OUT) buffer VelocityOut { vec4 velocity_out[]; };
// Change of velocity of each node by them, and then by colliders [m/s], and in w the mask of its
// edges that have one; from WORK_AT on the velocity of each node in a round [m/s], and in w its
// listed edges over its mass; after these, the impulses before the last round of limit/solve.comp.
layout(std430, binding = LIMIT_CHANGES) buffer Changes { vec4 changes[]; };

// False while more edges may come to those listed: then nodes keep what the springs gave them.
uniform bool gives;

// Return how many edges that start at the node have an impulse, and the energy that it is given
// over its mass [m2/s2].
vec2 give(int index) {
    vec4 v = velocity_out[index];
    vec3 given = impulse_on(index);
    vec3 change = v.w * given;
    uint mask = 0u;
    for (uint asks = MASK(index); asks != 0u; asks &= asks - 1u) {
        int code = findLSB(asks);
        mask |= impulse(index, code & 3) != vec3(0.0) ? 1u << code : 0u;
    }
    vec3 expected = gives
        ? change : after_contact(index, v.xyz + change, v.w > 0.0) - v.xyz;
    changes[index] = vec4(expected, float(mask));
    if (gives) {
        velocity_out[index].xyz = changed_velocity(index, v.xyz, change);
        position_out[index].xyz = changed_position(
            index, position_out[index].xyz, h * change);
    }
    if (gives && held_at >= 0 && is_held_by_pin(load_position(index), v)) {
        held[held_entry(index)].xyz += given;
    }
    // By the mean of the velocities before and after all that acts in the substep.
    float energy = dot(
        0.5 * (load_velocity(index).xyz + v.xyz + change), v.w > 0.0 ? given : vec3(0.0));
    return vec2(float(bitCount(mask)), energy);
}
