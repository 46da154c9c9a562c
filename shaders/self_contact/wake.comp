// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Look at all contacts, CONTACTS_EACH an invocation. LOOKS 0: list those that act as they were found. 1:
// before rounds, list those that did not act and are going to. 2: the same in a later substep, at the
// gaps that they have now.

#define POSITIONS_ALONE 1
#include "lattice.glsl"
#include "state_in.glsl"
#include "self_contact/head.glsl"
#define LISTS_ACTING 1
#include "self_contact/contacts.glsl"
#include "self_contact/found_contact.glsl"

layout(local_size_x = SELF_LOCAL) in;

// Velocity of a node by the impulses of layers alone [m/s], computed by nodes.comp with IS_SUM 1.
layout(binding = SELF_VELOCITIES) uniform samplerBuffer velocities;
layout(std430, binding = SELF_CONTACTS) buffer SelfContacts { SelfContact contacts_found[]; };

#define FOUND 0
#define ASLEEP 1
#define AGAIN 2

uniform float substep;  // [s]

// Gap of a contact where the points of both sides that it was found at are now [m].
float gap_again(SelfContact found, vec4 weights) {
    vec3 x = load_position(found.nodes.x).xyz;
    vec3 d = vec3(0.0);
    for (int k = 1; k < 4; ++k) {
        d += weights[k] * (load_position(found.nodes[k]).xyz - x);
    }
    return gap_of(dot(d, found.normal.xyz) - abs(found.least), x);
}

float speed_along_normal(SelfContact found, vec4 weights) {
    vec3 u = vec3(0.0);
    for (int k = 0; k < 4; ++k) {
        u += weights[k] * texelFetch(velocities, found.nodes[k]).xyz;
    }
    return dot(u, found.normal.xyz);
}

uint contact_number(int k) {
    return (gl_WorkGroupID.x * uint(CONTACTS_EACH) + uint(k)) * uint(SELF_LOCAL)
        + gl_LocalInvocationID.x;
}

void main() {
    uint listed = 0u;
#if LOOKS == AGAIN
    float nearest = 1e30;
#endif
    for (int k = 0; k < CONTACTS_EACH; ++k) {
        uint i = contact_number(k);
        bool is_there = i < contact_count;
        SelfContact found = load_contact(int(is_there ? i : 0u));
        bool acts = found.least > 0.0;
#if LOOKS == FOUND
        listed |= is_there && acts ? 1u << k : 0u;
#else
        vec4 weights = all_weights(found.weights);
        float gap = found.normal.w;
#if LOOKS == AGAIN
        gap = gap_again(found, weights);
        if (is_there) {
            contacts_found[i].normal.w = gap;
        }
        nearest = is_there ? min(nearest, max(gap + abs(found.least), 0.0)) : nearest;
#endif
        bool is_closing =
            gap <= 0.0 || speed_along_normal(found, weights) + gap / substep < 0.0;
        listed |= is_there && !acts && is_closing ? 1u << k : 0u;
#endif
    }
#if LOOKS == AGAIN
    if (nearest < 1e30) {
        atomicMin(least_distance, floatBitsToUint(nearest));
    }
#endif
    for (uint rest = listed; rest != 0u; rest &= rest - 1u) {
        uint i = contact_number(findLSB(rest));
        SelfContact found = load_contact(int(i));
        contacts_found[i].least = abs(found.least);
        list_acting(i, found.nodes, all_weights(found.weights), found.impulse.xyz);
    }
}
