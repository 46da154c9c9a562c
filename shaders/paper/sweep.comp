// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The paper's adaptive scheme (Tab. 9): edges that are beyond their limit now are brought to their
// rest length, to first order. Gauss-Seidel over the four edges of a cell an invocation; cells of
// one colour share no node, so the order is fixed and velocities are changed in place.

#include "lattice.glsl"
#include "state_in.glsl"
#include "spring_law.glsl"
#include "strain_limit.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = VELOCITY_OUT) buffer Velocity { vec4 velocity_out[]; };
layout(std430, binding = TENSION) buffer Tension { vec4 tension_out[]; };

// What an invocation reads no other one of the dispatch writes, so textures may have it.
#if LOADS_TEXTURE
layout(binding = TENSION) uniform samplerBuffer tension_in;
#define LOAD_VELOCITY(index) load_velocity(index)
#define LOAD_TENSIONS(index) texelFetch(tension_in, index)
#else
#define LOAD_VELOCITY(index) velocity_out[index]
#define LOAD_TENSIONS(index) tension_out[index]
#endif

uniform int colour;          // 0 to 3: parity of the cell's column and row
uniform float substep;       // [s]
uniform float kick;          // [s] what tensions act for, as the springs' forces
uniform float inverse_mass;  // [1/kg]

// Compliance of the constraints: without it the sum of those that share nodes diverges.
#define COMPLIANCE 1e-3

struct Node {
    vec4 position;
    vec4 velocity;
};

Node load_node(int index) { return Node(load_position(index), LOAD_VELOCITY(index)); }

float limit_edge(float old, inout Node from, inout Node to, int rest) {
    vec3 d = to.position.xyz - from.position.xyz;
    vec3 dv = to.velocity.xyz - from.velocity.xyz;
    vec2 now = length_and_inverse(d);
    float L0 = rest_length[rest];
    float free = from.velocity.w + to.velocity.w;
    // 0 where an end is a ghost or none can move.
    float present = from.position.w * to.position.w * min(free, 1.0);
    float per_length = present / (substep * kick * inverse_mass * max(free, 1.0));
    // Phi = d.d - L0^2 and its change, over 2 l.
    float ahead = (0.5 * (now.x * now.x - L0 * L0) + substep * dot(d, dv)) * now.y;
    float tension = is_beyond_limit(now.x, L0)
        ? (old + ahead * per_length) / (1.0 + COMPLIANCE) : 0.0;
    vec3 change = (present * (tension - old) * kick * inverse_mass * now.y) * d;
    from.velocity.xyz += from.velocity.w * change;
    to.velocity.xyz -= to.velocity.w * change;
    return tension;
}

void main() {
    int col = 2 * int(gl_GlobalInvocationID.x) + (colour & 1);
    int row = 2 * int(gl_GlobalInvocationID.y) + (colour >> 1);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    int index = node_index(row, col);
    Node corner = load_node(index);
    Node right = load_node(index + 1);
    Node below = load_node(index + PITCH);
    Node across = load_node(index + PITCH + 1);
    vec4 t = LOAD_TENSIONS(index);
#if HAS_STRUCTURAL
    t[EDGE_ROW] = limit_edge(t[EDGE_ROW], corner, right, REST_ROW);
    t[EDGE_COLUMN] = limit_edge(t[EDGE_COLUMN], corner, below, REST_COLUMN);
#endif
#if HAS_SHEAR
    t[EDGE_DIAGONAL] = limit_edge(t[EDGE_DIAGONAL], corner, across, REST_DIAGONAL);
    t[EDGE_CROSSING] = limit_edge(t[EDGE_CROSSING], right, below, REST_DIAGONAL);
#endif
    tension_out[index] = t;
    // Ghosts are as they were, and no other invocation reads them now.
    velocity_out[index] = corner.velocity;
    velocity_out[index + 1] = right.velocity;
    velocity_out[index + PITCH] = below.velocity;
    velocity_out[index + PITCH + 1] = across.velocity;
}
