#version 430 core
// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The accelerations that air gives to the nodes, on top of what pushes on regions add: each node
// gathers from its triangles. A cell is cut both ways, so that no direction is preferred: four
// triangles of half the weight, three of them with a corner at a node of the cell. Nodes of equal
// mass have equal areas, so those at a border count twice in their triangles, at a corner four
// times. With cells a node has the area of its triangles, and each counts once.
// MEASURES_RATE: find the fastest rate at which air would slow a triangle instead, in strips.

#include "lattice.glsl"
#include "state_in.glsl"
#include "applied_acceleration.glsl"
#include "air_law.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

#if MEASURES_RATE
layout(std430, binding = PARTIAL_SUMS) writeonly buffer PartialSums { float partial_sums[]; };
#else
layout(std430, binding = AIR_OUT) writeonly buffer AirOut { vec4 air_out[]; };
#endif

uniform vec3 past;           // [m/s] the wind less what gravity adds to a free cloth in the lead
uniform float inverse_area;  // [1/m2] of a cell at rest
uniform ivec2 stack;         // rows of a cloth, and from one cloth to the next

// An inner node has a part in 12 triangles.
#define SHARE (1.0 / 12.0)

struct Node {
    vec4 position;
    vec4 velocity;  // times how often the node counts, which stands in w
};

// row_of_cloth: counted from the first row of the cloth that the node is of.
Node load_node(int row, int col, int row_of_cloth) {
    int index = node_index(row, col);
#if HAS_CELLS
    float counts = 1.0;
#else
    float counts = (row_of_cloth == 0 || row_of_cloth == stack.x - 1 ? 2.0 : 1.0)
        * (col == 0 || col == COLS - 1 ? 2.0 : 1.0);
#endif
    return Node(load_position(index), vec4(counts * load_velocity(index).xyz, counts));
}

vec3 triangle(Node corner, Node one, Node other) {
    vec4 v = corner.velocity + one.velocity + other.velocity;
    // Which side is up does not matter to the air.
    vec3 area = inverse_area * cross(
        one.position.xyz - corner.position.xyz, other.position.xyz - corner.position.xyz);
    return air_acceleration(area, past - (1.0 / v.w) * v.xyz);
}

// The triangles of a cell that have a corner here; first and last are its upper left and its lower
// right corner.
vec3 cell(Node here, Node side, Node other_side, Node across, Node first, Node last) {
    // 0 where the cell is beyond the border, or a hole.
#if HAS_CELLS
    float present = edge_share(first.position, last.position, EDGE_DIAGONAL);
#else
    float present = side.position.w * other_side.position.w * across.position.w;
#endif
#if MEASURES_RATE
    if (present == 0.0) {
        return vec3(0.0);
    }
#endif
    return present * (triangle(here, side, other_side) + triangle(side, here, across)
        + triangle(other_side, here, across));
}

vec3 given_at(int row, int col, Node here) {
    int of_cloth = row % stack.y;
    Node left = load_node(row, col - 1, of_cloth);
    Node right = load_node(row, col + 1, of_cloth);
    Node above = load_node(row - 1, col, of_cloth - 1);
    Node below = load_node(row + 1, col, of_cloth + 1);
    Node across = load_node(row - 1, col - 1, of_cloth - 1);
    vec3 given = cell(here, left, above, across, across, here);
    given += cell(
        here, right, above, load_node(row - 1, col + 1, of_cloth - 1), above, right);
    given += cell(here, left, below, load_node(row + 1, col - 1, of_cloth + 1), left, below);
    across = load_node(row + 1, col + 1, of_cloth + 1);
    given += cell(here, right, below, across, here, across);
    return given;
}

#if MEASURES_RATE
void main() {
    int col = int(gl_GlobalInvocationID.x);
    int strip = int(gl_GlobalInvocationID.y);
    int first = strip * STRIP;
    if (first >= ROWS || col >= COLS) {
        return;
    }
    for (int row = first; row < min(first + STRIP, ROWS); ++row) {
        given_at(row, col, load_node(row, col, row % stack.y));
    }
    partial_sums[strip * COLS + col] = fastest_rate;
}
#else
void main() {
    int row = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    Node here = load_node(row, col, row % stack.y);
    vec3 given = given_at(row, col, here);
    int index = node_index(row, col);
    vec4 pushed = has_region_pushes ? load_region_pushes(index) : vec4(0.0);
    // Not 0 where there is no node.
    float mass = max(mass_share(here.position), 0.25);
    air_out[index] = vec4(pushed.xyz + SHARE * here.velocity.w / mass * given, pushed.w);
}
#endif
