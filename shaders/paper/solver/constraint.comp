// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// A row of J, and its right side: disConstraint(), Vect() and Rhs() of the paper, with unit rows.
// Starts conjugate gradients from zero.

#include "paper/solver/buffers.glsl"

layout(local_size_x = 1024) in;

uniform float substep;  // [s]

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= CONSTRAINTS) {
        return;
    }
    ivec2 ends = ivec2(edges[i].xy);
    vec3 d = nodes[ends.x].xyz - nodes[ends.y].xyz;
    vec3 direction = d / length(d);
    for (int axis = 0; axis < 3; ++axis) {
        a[VALUES * i + axis] = direction[axis];
        a[VALUES * i + 3 + axis] = -direction[axis];
        ja[VALUES * i + axis] = 3 * ends.x + axis;
        ja[VALUES * i + 3 + axis] = 3 * ends.y + axis;
    }
    vec3 relative = nodes[NODES + ends.x].xyz - nodes[NODES + ends.y].xyz;
    float right = (length(d) - edges[i].z) / (substep * substep)
        + dot(direction, relative) / substep;
    ENTRY(LAMBDA, i) = 0.0;
    ENTRY(RESIDUAL, i) = right;
    ENTRY(DIRECTION, i) = right;
    row_count[i] = 0u;
}
