// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Mark the edges of each cell, four bits a mark: which come so near their limit that it holds them
// now, which are engaged, and which were the time before. An edge is engaged when it is held, and
// until it has been let go and has come back some way.

#include "lattice.glsl"
#include "state_in.glsl"
#include "spring_law.glsl"
#include "strain_limit.glsl"

#define ENGAGED 4
#define ENGAGED_BEFORE 8

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = AT_LIMIT) buffer AtLimit { uint at_limit[]; };

// Changes of velocity of limit_give.glsl, and in w which edges of a node have an impulse.
layout(std430, binding = LIMIT_CHANGES) readonly buffer Changes { vec4 changes[]; };

uniform bool has_changes;
uniform float onset;    // strain from which on a limit pulls, where there are no changes
uniform float release;  // of the limit: an edge stays engaged above this strain

float strain(int row, int col, int row2, int col2, int edge, int rest) {
    vec4 from = load_position(node_index(row, col));
    vec4 to = load_position(node_index(row2, col2));
    float l = length_and_inverse(to.xyz - from.xyz).x;
    return edge_share(from, to, edge) > 0.0 ? abs(l / rest_length[rest] - 1.0) : 0.0;
}

uint mark(uint before, uint pulled, int edge, float strain) {
    uint bit = 1u << edge;
    if (has_changes ? (pulled & bit) != 0u : strain > onset) {
        return bit | bit << ENGAGED;
    }
    return strain > release * limit ? before & bit << ENGAGED : 0u;
}

// The edges that start at a node and have an impulse, of extension or compression.
uint pulled_at(int index) {
    uint pulled = has_changes ? uint(changes[index].w) : 0u;
    return pulled | pulled >> 4;
}

void main() {
    int col = int(gl_GlobalInvocationID.x);
    int row = int(gl_GlobalInvocationID.y);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    int index = node_index(row, col);
    uint before = at_limit[index];
    uint pulled = pulled_at(index);
    uint marks = 0u;
#if HAS_STRUCTURAL
    marks |= mark(before, pulled, EDGE_ROW, strain(row, col, row, col + 1, EDGE_ROW, REST_ROW));
    marks |= mark(before, pulled, EDGE_COLUMN, strain(row, col, row + 1, col, EDGE_COLUMN, REST_COLUMN));
#endif
#if HAS_SHEAR
    marks |= mark(
        before, pulled, EDGE_DIAGONAL,
        strain(row, col, row + 1, col + 1, EDGE_DIAGONAL, REST_DIAGONAL));
    marks |= mark(
        before, pulled_at(index + 1), EDGE_CROSSING,
        strain(row, col + 1, row + 1, col, EDGE_CROSSING, REST_DIAGONAL));
#endif
    at_limit[index] = marks | (before >> ENGAGED & 15u) << ENGAGED_BEFORE;
}
