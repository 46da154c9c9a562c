// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Count the edges that pierce triangles, those of one node an invocation, by signs of volumes.

#define POSITIONS_ALONE 1
#include "lattice.glsl"
#include "state_in.glsl"
#include "self_contact/features.glsl"
#include "self_contact/owned.glsl"
#include "self_contact/boxes.glsl"
#include "self_contact/head.glsl"

layout(local_size_x = SELF_LOCAL) in;

// Volume over the third power of the longest distance of four points [1], up to which it may be that of
// rounding: of flat layers, all volumes are. Ten times the rounding of its products.
#define ROUNDED 1e-6

// Six times the signed volume of a tetrahedron with a corner at the origin [m3].
float volume(vec3 a, vec3 b, vec3 c) { return dot(cross(a, b), c); }

float square(vec3 v) { return dot(v, v); }

bool pierces(vec3 p, vec3 q, vec3 a, vec3 b, vec3 c) {
    vec3 d = q - p;
    a -= p;
    b -= p;
    c -= p;
    vec3 across = cross(b - a, c - a);
    vec3 around = vec3(volume(a, b, d), volume(b, c, d), volume(c, a, d));
    float longest = sqrt(max(max(square(a), square(b)), max(square(c), square(d))));
    float least = ROUNDED * longest * longest * longest;
    float begin = dot(across, a), end = dot(across, a - d);
    return min(begin, end) < -least && max(begin, end) > least
        && (all(greaterThan(around, vec3(least))) || all(lessThan(around, vec3(-least))));
}

void count_crossings(Owned one, Owned other) {
    for (int kind = RIGHT; kind <= ACROSS; ++kind) {
        ivec2 own = edge_nodes(4 * one.index + kind);
        ivec2 ends = edge_corners(kind);
        for (int face = 0; face < 2; ++face) {
            ivec3 nodes = face_nodes(2 * other.index + face);
            bool is_apart = !any(equal(nodes, ivec3(own.x))) && !any(equal(nodes, ivec3(own.y)));
            bool crosses = pierces(
                one.corner[ends.x], one.corner[ends.y], other.corner[face], other.corner[2],
                other.corner[face == 0 ? 1 : 3]);
            if (owns_edge(one, kind) && is_apart && crosses) {
                atomicAdd(crossing_edges, 1u);
                atomicMin(first_crossing, uint(one.index));
            }
        }
    }
}

void main() {
    int place = int(gl_GlobalInvocationID.x);
    if (place >= ROWS * COLS) {
        return;
    }
    Owned one = owned_by(node_index(place / COLS, place % COLS));
    Box own = load_box(place);
    Walk walk = Walk((one.features & OWNS_NODE) != 0u ? level_count - 1 : level_count, ivec2(0));
    while (walk.level < level_count) {
        bool is_near = is_box_near(walk, own);
        if (is_near && walk.level == 0) {
            Owned other = owned_by(node_index(walk.at.x, walk.at.y));
            if ((other.features & OWNS_CELL) != 0u) {
                count_crossings(one, other);
            }
        }
        walk_on(walk, is_near);
    }
    if (walk.level < level_count) {
        atomicAdd(unfinished, 1u);
    }
}
