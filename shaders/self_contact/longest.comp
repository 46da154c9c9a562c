// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The longest way of a node in the substep, and how much farther nodes have moved since the lists were
// made than these allow for: STRIP nodes of a column an invocation.

#define POSITIONS_ALONE 1
#include "lattice.glsl"
#include "state_in.glsl"
#include "self_contact/head.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(binding = POSITION_OUT) uniform samplerBuffer position_out;
layout(binding = SELF_BUILT) uniform samplerBuffer built;

uniform float room;          // [m] that nodes may move since lists were made
uniform vec3 common_way;     // [m] of all nodes in the substep
uniform vec3 common_moved;   // [m] of all nodes since lists were made

void main() {
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, STRIP);
    if (first.x >= COLS || first.y >= ROWS) {
        return;
    }
    float longest = 0.0, farthest = 0.0;
    for (int i = 0; i < STRIP && first.y + i < ROWS; ++i) {
        int index = node_index(first.y + i, first.x);
        vec4 x = load_position(index);
        float l = length(texelFetch(position_out, index).xyz - x.xyz - common_way);
        float moved = length(x.xyz - texelFetch(built, index).xyz - common_moved);
        longest = max(longest, x.w != 0.0 ? l : 0.0);
        farthest = max(farthest, x.w != 0.0 ? l + moved : 0.0);
    }
    atomicMax(longest_way, floatBitsToUint(longest));
    if (farthest > room) {
        atomicAdd(cut_nodes, 1u);
    }
}
