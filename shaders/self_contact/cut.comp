// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Shorten the ways of nodes as guard.comp asks, and to what the lists of pairs allow for: STRIP nodes
// of a column an invocation. Velocities stay, and so does momentum.

#define POSITIONS_ALONE 1
#include "lattice.glsl"
#include "state_in.glsl"
#include "self_contact/head.glsl"
#include "self_contact/contacts.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = POSITION_OUT) buffer PositionOut { vec4 position_out[]; };
layout(binding = VELOCITY_OUT) uniform samplerBuffer velocity_out;
layout(binding = SELF_BUILT) uniform samplerBuffer built;

uniform float room;         // [m] that nodes may move since lists were made
uniform vec3 common_way;   // [m] of all nodes in the substep
uniform vec3 common_moved;  // [m] of all nodes since lists were made

void main() {
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, STRIP);
    if (first.x >= COLS || first.y >= ROWS) {
        return;
    }
    float longest = 0.0, most_cut = 0.0;
    uint cuts = 0u, pins = 0u;
    for (int i = 0; i < STRIP && first.y + i < ROWS; ++i) {
        int index = node_index(first.y + i, first.x);
        vec4 x = load_position(index);
        if (x.w == 0.0) {
            continue;
        }
        vec3 way = position_out[index].xyz - x.xyz - common_way;
        float l = length(way);
        float part = uintBitsToFloat(self_nodes[index].cut);
        float left = room - length(x.xyz - texelFetch(built, index).xyz - common_moved);
        part = l > left ? min(part, max(left, 0.0) / l) : part;
        longest = max(longest, part * l);
        if (part < 1.0) {
            self_nodes[index].cut = floatBitsToUint(1.0);
            position_out[index].xyz = x.xyz + common_way + part * way;
            most_cut = max(most_cut, (1.0 - part) * l);
            ++cuts;
            pins += texelFetch(velocity_out, index).w == 0.0 ? 1u : 0u;
        }
    }
    atomicMax(longest_way, floatBitsToUint(longest));
    if (cuts > 0u) {
        atomicMax(largest_cut, floatBitsToUint(most_cut));
        atomicAdd(cut_nodes, cuts);
        atomicAdd(cut_pins, pins);
    }
}
