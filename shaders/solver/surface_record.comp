// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Record the impulses of contacts with thin colliders of a substep that ends, with what they do to
// pinned nodes: one workgroup.

#include "solver/levels.glsl"
#include "solver/state_index.glsl"
#include "state_in.glsl"
#include "contact.glsl"
#include "contact_record.glsl"
#include "held.glsl"

layout(local_size_x = SURFACE_LOCAL) in;

uniform float substep;  // [s]

#define KNOWS_COLLIDERS
#include "solver/surface_contacts.glsl"

// Impulses on a node by one collider [m/s], and FREE, STICKS or SLIDES.
vec4 given_by(int index, int collider) {
    SurfaceHold node = surface_holds[index];
    vec4 sum = vec4(0.0);
    for (int i = node.first; i < node.first + node.count; ++i) {
        SurfaceContact contact = surface_contacts[contact_of_node(i)];
        if (int(contact.weights.w) == collider && contact.given.xyz != vec3(0.0)) {
            bool sticks = contact.begun.w > 0.0 && contact.begun.w == contact.sticking.x;
            sum = vec4(sum.xyz + weight_of_node(i, contact) * contact.given.xyz,
                max(sum.w, float(sticks ? STICKS : SLIDES)));
        }
    }
    return sum;
}

void main() {
    for (uint i = gl_LocalInvocationID.x; i < held_nodes; i += SURFACE_LOCAL) {
        int index = int(surface_lists[uint(HELD_AT) + i]);
        int at = state_index(index / PITCH - HALO, index % PITCH - HALO);
        for (uint bodies = SURFACE_COLLIDERS; bodies != 0u; bodies &= bodies - 1u) {
            int collider = findLSB(bodies);
            vec4 given = given_by(index, collider);
            if (given.w > 0.0) {
                int entry = collider * record_stride + at;
                contacts[entry] = vec4(
                    contacts[entry].xyz + given.xyz, max(contacts[entry].w, given.w));
            }
        }
        if (held_at >= 0 && is_held_by_pin(load_position(at), load_velocity(at))) {
            held[held_entry(at)].xyz += surface_holds[index].given;
        }
        surface_holds[index].given = vec3(0.0);
    }
}
