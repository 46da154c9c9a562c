// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// How fast edges turn, and the strain of structural and shear edges: the largest of each, for each
// invocation, which looks at STRIP nodes of a column. The reader takes the largest of them.
// HAS_CONTACT: the velocities are those that foresee_contact.comp expects.

#include "lattice.glsl"
#include "state_in.glsl"
#include "applied_acceleration.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = PARTIAL_SUMS) writeonly buffer PartialSums { float partial_sums[]; };

uniform float substep;         // [s] that the acceleration is foreseen for
uniform float rest_length[5];  // [m] along a row, along a column, diagonal, two along each

// The node after a substep of the applied acceleration, but where it is now.
struct Node {
    vec4 position;
    vec3 velocity;
};

Node load_node(int row, int col) {
    int index = node_index(row, col);
    vec4 v = load_velocity(index);
#if !HAS_CONTACT
    v.xyz += v.w * substep * applied_acceleration(index);
#endif
    return Node(load_position(index), v.xyz);
}

// Square of the angular velocity, as if the edge had its rest length [1/s2], and its strain.
vec2 turn_and_strain(Node here, int row, int col, int drow, int dcol, int family, int rest) {
    Node there = load_node(row + drow, col + dcol);
    vec3 d = there.position.xyz - here.position.xyz;
    vec3 u = there.velocity - here.velocity;
    vec3 across = u - (dot(u, d) / max(dot(d, d), 1e-20)) * d;
    float present = there.position.w;
    return present * vec2(
        dot(across, across) / (rest_length[rest] * rest_length[rest]),
        family != BEND ? abs(length(d) / rest_length[rest] - 1.0) : 0.0);
}

#define LOOK(MOST, EDGE, DROW, DCOL, FAMILY, REST) \
    MOST = max(MOST, turn_and_strain(here, row, col, DROW, DCOL, FAMILY, REST));

void main() {
    int col = int(gl_GlobalInvocationID.x);
    int strip = int(gl_GlobalInvocationID.y);
    int first = strip * STRIP;
    if (first >= ROWS || col >= COLS) {
        return;
    }
    vec2 most = vec2(0.0);
    for (int row = first; row < min(first + STRIP, ROWS); ++row) {
        Node here = load_node(row, col);
        EACH_EDGE(LOOK, most)
    }
    int entry = 2 * (strip * COLS + col);
    partial_sums[entry] = most.x;
    partial_sums[entry + 1] = most.y;
}
