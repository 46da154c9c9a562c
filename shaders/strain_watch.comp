// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The largest strain now and the largest one predicted for a time ahead, for each invocation,
// which looks at STRIP nodes of a column. The reader takes the largest of them: that needs no
// barriers. HAS_CONTACT: the velocities are those that foresee_contact.comp expects.

#include "lattice.glsl"
#include "state_in.glsl"
#include "spring_law.glsl"
#include "applied_acceleration.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = PARTIAL_SUMS) writeonly buffer PartialSums { float partial_sums[]; };

uniform float substep;  // [s] of all substeps until the time ahead

struct Node {
    vec4 now;
    vec4 then;
};

Node load_node(int row, int col) {
    int index = node_index(row, col);
    vec4 x = load_position(index);
    vec4 v = load_velocity(index);
    vec3 expected = v.xyz;
#if !HAS_CONTACT
    expected += v.w > 0.0 ? substep * applied_acceleration(index) : vec3(0.0);
#endif
    return Node(x, vec4(x.xyz + substep * expected, v.w));
}

void look_at_edge(inout vec2 strain, Node from, Node to, int edge, int rest) {
    // 0 where an end is a ghost or none can move.
    bool is_edge = edge_share(from.now, to.now, edge) > 0.0;
    float present = is_edge ? min(from.then.w + to.then.w, 1.0) : 0.0;
    float per_rest = present / rest_length[rest];
    float now = length_and_inverse(to.now.xyz - from.now.xyz).x;
    float then = length_and_inverse(to.then.xyz - from.then.xyz).x;
    strain = max(strain, abs(vec2(now, then) - rest_length[rest]) * per_rest);
}

void main() {
    int col = int(gl_GlobalInvocationID.x);
    int strip = int(gl_GlobalInvocationID.y);
    int first = strip * STRIP;
    if (first >= ROWS || col >= COLS) {
        return;
    }
    vec2 strain = vec2(0.0);
    Node here = load_node(first, col);
    Node right = load_node(first, col + 1);
    for (int row = first; row < min(first + STRIP, ROWS); ++row) {
        Node below = load_node(row + 1, col);
        Node below_right = load_node(row + 1, col + 1);
#if HAS_STRUCTURAL
        look_at_edge(strain, here, right, EDGE_ROW, REST_ROW);
        look_at_edge(strain, here, below, EDGE_COLUMN, REST_COLUMN);
#endif
#if HAS_SHEAR
        look_at_edge(strain, here, below_right, EDGE_DIAGONAL, REST_DIAGONAL);
        look_at_edge(strain, right, below, EDGE_CROSSING, REST_DIAGONAL);
#endif
        here = below;
        right = below_right;
    }
    partial_sums[2 * (strip * COLS + col)] = strain.x;
    partial_sums[2 * (strip * COLS + col) + 1] = strain.y;
}
