// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// List the nodes that may come to a collider in an explicit substep that has been made, whose
// velocities are bound for reading: by a
// sphere around each collider, which is cheap beside what contact.comp does with each of them. The
// sphere around a block of nodes is asked first, which rules most of them out at once.

#include "lattice.glsl"
#include "state_in.glsl"
#include "contact.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

#include "near_nodes.glsl"

// More than the rounding of a radius.
#define WIDER 1.00001

uniform float substep;  // [s]

// How far a node goes; what is no number goes far.
float way_of(vec4 v) {
    float square = dot(v.xyz, v.xyz);
    return substep * sqrt(square < 1e30 ? square : 1e30);
}

void list_if_near(int index, uint bodies) {
    vec4 v = load_velocity(index);
    vec3 x = load_position(index).xyz;
    float nearest = 1e30;
    for (; bodies != 0u; bodies &= bodies - 1u) {
        nearest = min(nearest, least_way(findLSB(bodies), x, 0.0));
    }
    // Written so that what is no number is near.
    if (v.w > 0.0 && !(nearest > way_of(v))) {
        uint place = atomicAdd(near_count, 1u);
        near_nodes[place] = uint(index);
        atomicMax(near_groups_x, place / NEAR_LOCAL + 1u);
    }
}

void main() {
    ivec2 first = BLOCK * ivec2(gl_GlobalInvocationID.yx);
    ivec2 size = clamp(ivec2(ROWS, COLS) - first, ivec2(0), ivec2(BLOCK));
    vec3 least = vec3(1e30);
    vec3 most = vec3(-1e30);
    vec4 fastest = vec4(0.0);
    for (int row = 0; row < BLOCK; ++row) {
        for (int col = 0; col < BLOCK; ++col) {
            // The nodes at an edge count more than once, which a bound allows.
            ivec2 at = min(first + ivec2(row, col), ivec2(ROWS, COLS) - 1);
            int index = node_index(at.x, at.y);
            vec3 x = load_position(index).xyz;
            vec4 v = load_velocity(index);
            least = min(least, x);
            most = max(most, x);
            fastest = dot(v.xyz, v.xyz) <= dot(fastest.xyz, fastest.xyz) ? fastest : v;
        }
    }
    uint bodies = near_bodies(
        0.5 * (least + most), 0.5 * WIDER * length(most - least), way_of(fastest));
    // A loop that ends at once costs software less than a branch, whose body it runs.
    int rows = bodies != 0u ? size.x : 0;
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < size.y; ++col) {
            list_if_near(node_index(first.x + row, first.y + col), bodies);
        }
    }
}
