// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Let pairs that were listed before keep their impulses, one of those an invocation.

#include "self_contact/head.glsl"
#include "lattice.glsl"
#include "self_contact/features.glsl"
#include "self_contact/pairs.glsl"

layout(local_size_x = SELF_LOCAL) in;

layout(std430, binding = SELF_FIRST) readonly buffer SelfFirst { uint first_pair[]; };
layout(std430, binding = SELF_PAIRS) readonly buffer SelfPairs { Pair pairs[]; };
layout(std430, binding = SELF_KEPT) buffer SelfKept { vec4 kept[]; };
layout(std430, binding = SELF_PAIRS_BEFORE) readonly buffer SelfPairsBefore { Pair pairs_before[]; };
layout(std430, binding = SELF_KEPT_BEFORE) readonly buffer SelfKeptBefore { vec4 kept_before[]; };

uniform ivec4 before;  // pairs of nodes and of edges, and room, as there were

void main() {
    int i = int(pair_number());
    if (i >= before.x + before.y) {
        return;
    }
    i = i < before.x ? i : before.z - 1 - (i - before.x);
    vec4 impulse = kept_before[i];
    if (impulse.xyz == vec3(0.0)) {
        return;
    }
    uint own = pairs_before[i].own, other = pairs_before[i].other;
    uint next = first_pair[own >> 2];
    while (next != 0u) {
        uint place = next - 1u;
        if (pairs[place].own == own && pairs[place].other == other) {
            kept[place] = impulse;
        }
        next = pairs[place].next;
    }
}
