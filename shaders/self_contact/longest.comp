// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Reduce over the nodes, STRIP of a column an invocation: the largest displacement in the substep, and
// whether any exceeds what the lists allow for. Add up the displacement of each cell.

#define POSITIONS_ALONE 1
#include "lattice.glsl"
#include "state_in.glsl"
#include "self_contact/head.glsl"
#include "self_contact/cell_ways.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(binding = POSITION_OUT) uniform samplerBuffer position_out;
layout(binding = SELF_BUILT) uniform samplerBuffer built;
layout(binding = SELF_WAYS) uniform samplerBuffer way_texels;

uniform float room;          // [m] that nodes may move since lists were made
uniform vec3 common_way;     // [m] of all nodes in the substep
uniform vec3 common_moved;   // [m] of all nodes since lists were made

void add_cell_way(int index, float way) {
    cell_ways[index].xy = vec2(texelFetch(way_texels, index).x + way, way);
}

// Displacement of a node in the substep, and since lists were made until its begin [m].
vec2 way_of(int index) {
    vec4 x = load_position(index);
    vec3 way = texelFetch(position_out, index).xyz - x.xyz - common_way;
    vec3 moved = x.xyz - texelFetch(built, index).xyz - common_moved;
    return x.w != 0.0 ? vec2(length(way), length(moved)) : vec2(0.0);
}

void main() {
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, STRIP);
    if (first.x >= COLS || first.y >= ROWS) {
        return;
    }
    float longest = 0.0, farthest = 0.0;
    int last = min(first.y + STRIP, ROWS - 1);
    float upper = 0.0;
    for (int row = first.y; row <= last; ++row) {
        int index = node_index(row, first.x);
        vec2 found = way_of(index);
        float wider = max(found.x, way_of(index + 1).x);
        // The cell above this row, which the node above owns.
        if (row > first.y) {
            add_cell_way(index - PITCH, max(upper, wider));
        }
        // The last row belongs to the strip below, if there is one.
        if (row < first.y + STRIP) {
            longest = max(longest, found.x);
            farthest = max(farthest, found.x + found.y);
        }
        upper = wider;
    }
    if (last == ROWS - 1 && last < first.y + STRIP) {
        add_cell_way(node_index(last, first.x), upper);
    }
    atomicMax(longest_way, floatBitsToUint(longest));
    if (farthest > room) {
        atomicAdd(cut_nodes, 1u);
    }
}
