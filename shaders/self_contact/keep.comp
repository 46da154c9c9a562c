// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Copy the impulses of the contacts that acted last to the new list of pairs, one contact an
// invocation.

#include "lattice.glsl"
#include "self_contact/head.glsl"
#include "self_contact/pairs.glsl"
#include "self_contact/contacts.glsl"
#include "self_contact/found_contact.glsl"

layout(local_size_x = SELF_LOCAL) in;

layout(binding = SELF_FIRST) uniform samplerBuffer first_texels;
layout(binding = SELF_PAIRS_BEFORE) uniform samplerBuffer before_texels;
layout(std430, binding = SELF_KEPT) writeonly buffer SelfKept { vec4 kept[]; };

// First of the chain of pairs of a node, one more than its place.
uint first_pair(uint node) {
    return floatBitsToUint(texelFetch(first_texels, int(node >> 2))[node & 3u]);
}

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= acting_count) {
        return;
    }
    vec4 own = load_acting(number);
    SelfContact found = load_contact(floatBitsToInt(own.w));
    Pair before = pair_of(texelFetch(before_texels, floatBitsToInt(found.impulse.w)));
    uint next = first_pair(before.own >> 2);
    while (next != 0u) {
        uint place = next - 1u;
        Pair pair = load_pair(place);
        bool is_same = pair.own == before.own && pair.other == before.other;
        if (is_same) {
            kept[place] = vec4(own.xyz, 0.0);
        }
        next = is_same ? 0u : pair.next;
    }
}
