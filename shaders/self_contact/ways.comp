// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// How far nodes have moved since the lists of pairs were made, with the present substep, and how
// fast they are, and the largest coordinate: STRIP nodes of a column an invocation.

#define POSITIONS_ALONE 1
#include "lattice.glsl"
#include "state_in.glsl"
#include "self_contact/head.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(binding = VELOCITY_OUT) uniform samplerBuffer velocity_out;
layout(binding = SELF_BUILT) uniform samplerBuffer built;

uniform float substep;  // [s]

void main() {
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, STRIP);
    if (first.x >= COLS || first.y >= ROWS) {
        return;
    }
    vec3 least = vec3(1e30), most = vec3(-1e30);
    vec3 slowest = vec3(1e30), fastest = vec3(-1e30);
    vec3 most_place = vec3(0.0);
    for (int i = 0; i < STRIP && first.y + i < ROWS; ++i) {
        int index = node_index(first.y + i, first.x);
        vec4 x = load_position(index);
        if (x.w == 0.0) {
            continue;
        }
        vec3 v = texelFetch(velocity_out, index).xyz;
        vec3 moved = x.xyz - texelFetch(built, index).xyz + substep * v;
        most_place = max(most_place, abs(x.xyz));
        least = min(least, moved);
        most = max(most, moved);
        slowest = min(slowest, v);
        fastest = max(fastest, v);
    }
    atomicMax(largest, floatBitsToUint(max(most_place.x, max(most_place.y, most_place.z))));
    for (int k = 0; k < 3; ++k) {
        atomicMin(least_moved[k], in_order(least[k]));
        atomicMax(most_moved[k], in_order(most[k]));
        atomicMin(least_speed[k], in_order(slowest[k]));
        atomicMax(most_speed[k], in_order(fastest[k]));
    }
}
