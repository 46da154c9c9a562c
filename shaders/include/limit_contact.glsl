// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Colliders have the last word on an explicit substep (contact.comp), so impulses of the limits
// are found for the velocities that nodes have after them.

float h = READ_FIRST(substep);

#if HAS_CONTACT
#include "contact.glsl"

vec3 after_contact(int index, vec3 velocity, bool is_free) {
    vec3 x = load_position(index).xyz;
    uint near = is_free ? near_bodies(x, 0.0, h * length(velocity)) : 0u;
    // As in solver/contact.comp, software would run the body of a branch for every node.
    for (uint asks = near != 0u ? 1u : 0u; asks != 0u; asks &= asks - 1u) {
        velocity = contact_with(near, x, velocity, velocity, h).velocity;
    }
    return velocity;
}
#else
vec3 after_contact(int index, vec3 velocity, bool is_free) { return velocity; }
#endif
