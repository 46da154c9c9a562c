// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Let the colliders act on an explicit substep that has been made, before it is the present state,
// at the nodes that near_colliders.comp lists.

#include "lattice.glsl"
#include "state_in.glsl"
#include "contact.glsl"

#include "near_nodes.glsl"

layout(local_size_x = NEAR_LOCAL) in;

layout(std430, binding = POSITION_OUT) buffer PositionOut { vec4 position_out[]; };
layout(std430, binding = VELOCITY_OUT) buffer VelocityOut { vec4 velocity_out[]; };

#include "contact_record.glsl"

uniform float substep;  // [s]

void main() {
    if (gl_GlobalInvocationID.x >= near_count) {
        return;
    }
    int index = int(near_nodes[gl_GlobalInvocationID.x]);
    vec4 v = velocity_out[index];
    vec4 x = load_position(index);
    Contact contact = contact_at(x.xyz, v.xyz, v.xyz, substep);
    if (touched_count == 0) {
        return;
    }
    vec3 to = position_out[index].xyz;
    if (contact.kind != FREE) {
        to = x.xyz + substep * contact.velocity;
        velocity_out[index] = vec4(contact.velocity, v.w);
    }
    position_out[index] = vec4(moved_out(to, substep), x.w);
    record_contacts(index, contact.kind);
}
