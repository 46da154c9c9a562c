// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Where a node of the cloth can go in a solve: along the surface that it touches, along the common
// line of two, nowhere where there are more. Its velocity is right in all other directions before.
// Friction that holds it resists in these directions.

#if HAS_CONTACT
vec4 load_contact(int index) { return load_system(cloth_entry(CONTACT, index)); }

// The direction in which friction does not resist, if any, and how much it does across that.
vec4 load_grip(int index) { return load_system(cloth_entry(GRIP, index)); }

bool is_held(int index) { return load_contact(index).w == 1.0; }

vec3 in_free_directions(int index, vec3 v) {
    vec4 contact = load_contact(index);
    vec3 along = dot(contact.xyz, v) * contact.xyz;
    return contact.w == 0.0 ? v : contact.w == 1.0 ? vec3(0.0)
        : contact.w == 2.0 ? v - along : along;
}

// Drag by friction for the value at a node.
vec3 gripped(int index, vec3 value) {
    vec4 grip = load_grip(index);
    return grip.w * (value - dot(grip.xyz, value) * grip.xyz);
}

// The directions that contact takes of a node, as a projection.
Symmetric taken_directions(int index) {
    vec4 contact = load_contact(index);
    Symmetric along = outer_square(contact.xyz);
    return contact.w == 0.0 ? Symmetric(0.0) : contact.w == 1.0 ? scaled_identity(1.0)
        : contact.w == 2.0 ? along : scaled_identity(1.0) - along;
}

Symmetric grip_tensor(int index) {
    vec4 grip = load_grip(index);
    return grip.w * (
        scaled_identity(1.0) - outer_square(grip.xyz) - taken_directions(index));
}
#else
bool is_held(int index) { return false; }

vec3 gripped(int index, vec3 value) { return vec3(0.0); }

vec3 in_free_directions(int index, vec3 v) { return v; }
#endif
