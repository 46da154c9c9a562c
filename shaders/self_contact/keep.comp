// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Let pairs that were listed before keep their impulses, one of those an invocation.

#include "self_contact/head.glsl"
#include "lattice.glsl"
#include "self_contact/features.glsl"
#include "self_contact/pairs.glsl"

layout(local_size_x = SELF_LOCAL) in;

layout(std430, binding = SELF_PAIRS) buffer SelfPairs { Pair pairs[]; };
layout(std430, binding = SELF_FIRST) readonly buffer SelfFirst { uint first_pair[]; };
layout(std430, binding = SELF_PAIRS_BEFORE) readonly buffer SelfPairsBefore { Pair pairs_before[]; };

uniform ivec4 before;  // pairs of nodes and of edges, and room, as there were

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= before.x + before.y) {
        return;
    }
    i = i < before.x ? i : before.z - 1 - (i - before.x);
    Pair pair = pairs_before[i];
    if (pair.kept[0] == 0.0 && pair.kept[1] == 0.0 && pair.kept[2] == 0.0) {
        return;
    }
    uint next = first_pair[pair.own >> 2];
    while (next != 0u) {
        Pair found = pairs[next - 1u];
        if (found.own == pair.own && found.other == pair.other) {
            pairs[next - 1u].kept = pair.kept;
        }
        next = found.next;
    }
}
