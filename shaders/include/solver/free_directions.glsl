// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Where a node of the cloth can go in a solve: nowhere while it sticks to a collider, along the
// surface while it slides on one, along their common line while it slides on two. Its velocity is
// right in all other directions before.

#if HAS_CONTACT
vec4 load_contact(int index) { return load_system(cloth_entry(CONTACT, index)); }

bool sticks(int index) { return load_contact(index).w == 1.0; }

vec3 in_free_directions(int index, vec3 v) {
    vec4 contact = load_contact(index);
    vec3 along = dot(contact.xyz, v) * contact.xyz;
    return contact.w == 0.0 ? v : contact.w == 1.0 ? vec3(0.0)
        : contact.w == 2.0 ? v - along : along;
}
#else
bool sticks(int index) { return false; }

vec3 in_free_directions(int index, vec3 v) { return v; }
#endif
