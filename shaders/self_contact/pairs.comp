// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// List the pairs of features that are nearer than the reach, those of one node an invocation.

#define POSITIONS_ALONE 1
#include "lattice.glsl"
#include "state_in.glsl"
#include "self_contact/features.glsl"
#include "self_contact/owned.glsl"
#include "self_contact/boxes.glsl"
#include "self_contact/nearest.glsl"
#include "self_contact/head.glsl"
#include "self_contact/pairs.glsl"

layout(local_size_x = SELF_LOCAL) in;

layout(std430, binding = SELF_FIRST) buffer SelfFirst { uint first_pair[]; };
layout(std430, binding = SELF_PAIRS) buffer SelfPairs { Pair pairs[]; };

// Nodes between two tests [1].
#define MOST_LISTED 64

uniform float reach;  // [m]

uint chain;

void add_pair(uint at, uint own, uint other, float distance) {
    if (at < uint(most_pairs)) {
        pairs[at] = Pair(own, other, distance, chain);
        chain = at + 1u;
    }
}

// Pairs are tested first, then those listed that are near: software stores for all of its lanes
// where one has a pair to store.

void add_edges(Owned one, Owned other) {
    float distances[9];
    uint near = 0u;
    for (int i = 0; i < 9; ++i) {
        int kind = RIGHT + i / 3, other_kind = RIGHT + i % 3;
        ivec2 own = edge_nodes(4 * one.index + kind);
        ivec2 nodes = edge_nodes(4 * other.index + other_kind);
        // Each pair once, and none that hangs together.
        bool counts = owns_edge(one, kind) && owns_edge(other, other_kind)
            && (other.index > one.index || other_kind > kind)
            && own.x != nodes.x && own.x != nodes.y && own.y != nodes.x && own.y != nodes.y;
        ivec2 ends = edge_corners(kind), other_ends = edge_corners(other_kind);
        vec3 x = one.corner[ends.x], d = one.corner[ends.y] - x;
        vec3 y = other.corner[other_ends.x], e = other.corner[other_ends.y] - y;
        vec3 found = nearest_on_segments(x, d, y, e);
        distances[i] = length(x + found.x * d - y - found.y * e);
        near |= counts && distances[i] <= reach ? 1u << i : 0u;
    }
    while (near != 0u) {
        int i = findLSB(near);
        near &= near - 1u;
        add_pair(
            uint(most_pairs) - 1u - atomicAdd(edge_pairs, 1u), uint(4 * one.index + RIGHT + i / 3),
            uint(4 * other.index + RIGHT + i % 3), distances[i]);
    }
}

void add_faces(Owned one, Owned other) {
    float distances[2];
    uint near = 0u;
    for (int face = 0; face < 2; ++face) {
        ivec3 nodes = face_nodes(2 * other.index + face);
        vec3 x = one.corner[0];
        vec3 a = other.corner[face] - x, b = other.corner[2] - x;
        vec3 c = other.corner[face == 0 ? 1 : 3] - x;
        int place;
        vec3 weights = nearest_in_triangle(a, b, c, place);
        distances[face] = length(weights.x * a + weights.y * b + weights.z * c);
        bool is_near = distances[face] <= reach && !any(equal(nodes, ivec3(one.index)));
        near |= is_near ? 1u << face : 0u;
    }
    while (near != 0u) {
        int face = findLSB(near);
        near &= near - 1u;
        add_pair(atomicAdd(vertex_pairs, 1u), uint(4 * one.index),
            uint(2 * other.index + face), distances[face]);
    }
}

void main() {
    int place = int(gl_GlobalInvocationID.x);
    if (place >= ROWS * COLS) {
        return;
    }
    Owned one = owned_by(node_index(place / COLS, place % COLS));
    Box own = load_box(place);
    own.least -= reach;
    own.most += reach;
    chain = 0u;
    Walk walk = Walk((one.features & OWNS_NODE) != 0u ? level_count - 1 : level_count, ivec2(0));
    // Nodes are listed first: software tests all of its lanes where one has a node to test.
    int listed[MOST_LISTED], listed_later[MOST_LISTED];
    while (walk.level < level_count) {
        int count = 0, later_count = 0;
        while (walk.level < level_count && count < MOST_LISTED) {
            bool is_near = is_box_near(walk, own);
            if (is_near && walk.level == 0) {
                int index = node_index(walk.at.x, walk.at.y);
                listed[count] = index;
                ++count;
                if (index >= one.index) {
                    listed_later[later_count] = index;
                    ++later_count;
                }
            }
            walk_on(walk, is_near);
        }
        for (int i = 0; i < count; ++i) {
            Owned other = owned_by(listed[i]);
            if ((other.features & OWNS_CELL) != 0u) {
                add_faces(one, other);
            }
        }
        for (int i = 0; i < later_count; ++i) {
            add_edges(one, owned_by(listed_later[i]));
        }
    }
    // llvmpipe ends all loops of an invocation after 65535 rounds in all.
    if (walk.level < level_count) {
        atomicAdd(unfinished, 1u);
    }
    first_pair[one.index] = chain;
}
