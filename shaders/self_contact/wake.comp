// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Look at all contacts before rounds, one an invocation: at their gaps, where they were found in an
// earlier substep, and at those that did not act and are going to.

#define POSITIONS_ALONE 1
#include "lattice.glsl"
#include "state_in.glsl"
#include "self_contact/head.glsl"
#define LISTS_ACTING 1
#include "self_contact/contacts.glsl"
#include "self_contact/found_contact.glsl"

layout(local_size_x = SELF_LOCAL) in;

layout(binding = VELOCITY_OUT) uniform samplerBuffer velocity_texels;
layout(binding = SELF_NODES) uniform samplerBuffer node_texels;
#if IS_IMPLICIT
layout(binding = SELF_APPLIED) uniform samplerBuffer applied;
#endif
layout(std430, binding = SELF_CONTACTS) buffer SelfContacts { SelfContact contacts_found[]; };

uniform float substep;  // [s]
uniform int again;      // whether contacts were found in an earlier substep

// Gap of a contact where the points of both sides that it was found at are now [m].
float gap_again(SelfContact found, vec4 weights) {
    vec3 x = load_position(found.nodes.x).xyz;
    vec3 d = vec3(0.0);
    for (int k = 1; k < 4; ++k) {
        d += weights[k] * (load_position(found.nodes[k]).xyz - x);
    }
    return gap_of(dot(d, found.normal.xyz) - abs(found.least), x);
}

// Velocity of a node [m/s] by the impulses of layers alone.
vec3 velocity_of(int index) {
    vec4 free = texelFetch(velocity_texels, index);
    vec3 impulse = impulse_unit * vec3(floatBitsToInt(texelFetch(node_texels, 3 * index).xyz));
#if IS_IMPLICIT
    impulse -= texelFetch(applied, index).xyz;
#endif
    return free.xyz + free.w * impulse;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= contact_count) {
        return;
    }
    SelfContact found = load_contact(int(i));
    vec4 weights = all_weights(found.weights);
    float gap = found.normal.w;
    if (again == 1) {
        gap = gap_again(found, weights);
        contacts_found[i].normal.w = gap;
        atomicMin(least_distance, floatBitsToUint(max(gap + abs(found.least), 0.0)));
    }
    if (found.least > 0.0) {
        return;
    }
    vec3 u = vec3(0.0);
    for (int k = 0; k < 4; ++k) {
        u += weights[k] * velocity_of(found.nodes[k]);
    }
    float along_normal = dot(u, found.normal.xyz);
    if (gap <= 0.0 || along_normal + gap / substep < 0.0) {
        contacts_found[i].least = -found.least;
        list_acting(i, found.nodes, weights);
    }
}
