// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// How fast edges turn, at most and in the mean, and the largest strain of structural and shear
// edges, for each invocation, which looks at STRIP nodes of a column.
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
    v.xyz += v.w > 0.0 ? substep * applied_acceleration(index) : vec3(0.0);
#endif
    return Node(load_position(index), v.xyz);
}

// Over some edges: the largest square of an angular velocity, as if the edge had its rest length
// [1/s2], and the largest strain; the sum of the energies that they lose, which grow with the fourth
// power of the angular velocity, and the mean of the squares, weighted with these.
struct Found {
    float turn;
    float strain;
    float weight;
    float mean_turn;
};

#define MOST_TURN 1e12  // [1/s2]

Found found_with(
        Found found, Node here, int row, int col, int drow, int dcol, int edge, int family,
        int rest) {
    Node there = load_node(row + drow, col + dcol);
    vec3 d = there.position.xyz - here.position.xyz;
    vec3 u = there.velocity - here.velocity;
    vec3 across = u - (dot(u, d) / max(dot(d, d), 1e-20)) * d;
    float present = edge_share(here.position, there.position, edge) > 0.0 ? 1.0 : 0.0;
    float square = rest_length[rest] * rest_length[rest];
    float turn = present * dot(across, across) / square;
    float strain = family != BEND ? present * abs(length(d) / rest_length[rest] - 1.0) : 0.0;
    // No substep is short enough for more, and powers of it have to be finite.
    float bounded = min(turn, MOST_TURN);
    float weight = square * bounded * bounded;
    float total = found.weight + weight;
    float share = weight / max(total, 1e-30);
    return Found(
        max(found.turn, turn), max(found.strain, strain), total,
        found.mean_turn + share * (bounded - found.mean_turn));
}

#define LOOK(FOUND, EDGE, DROW, DCOL, FAMILY, REST) \
    FOUND = found_with(FOUND, here, row, col, DROW, DCOL, EDGE, FAMILY, REST);

void main() {
    int col = int(gl_GlobalInvocationID.x);
    int strip = int(gl_GlobalInvocationID.y);
    int first = strip * STRIP;
    if (first >= ROWS || col >= COLS) {
        return;
    }
    Found found = Found(0.0, 0.0, 0.0, 0.0);
    for (int row = first; row < min(first + STRIP, ROWS); ++row) {
        Node here = load_node(row, col);
        EACH_EDGE(LOOK, found)
    }
    int entry = 4 * (strip * COLS + col);
    partial_sums[entry] = found.turn;
    partial_sums[entry + 1] = found.strain;
    partial_sums[entry + 2] = found.weight;
    partial_sums[entry + 3] = found.mean_turn;
}
