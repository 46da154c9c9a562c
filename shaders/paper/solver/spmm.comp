// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The system matrix J W J^T + E as triplets: the paper's Tab. 6, an invocation for each pair of
// constraints. W stands where the paper has unit masses, E regularises a matrix that is singular
// otherwise. The triplets of a row are kept together, so that the product with a vector needs no
// atomic sums of floats, which GLSL does not have.

#include "paper/solver/buffers.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

uniform float softness;  // E / h^2 over the rest length [1/(kg m)]

void main() {
    int i = int(gl_GlobalInvocationID.x);
    int j = int(gl_GlobalInvocationID.y);
    if (i >= CONSTRAINTS || j >= CONSTRAINTS) {
        return;
    }
    float value = 0.0;
    for (int of_row = VALUES * i; of_row < VALUES * (i + 1); ++of_row) {
        int column = ja[of_row];
        for (int of_column = VALUES * j; of_column < VALUES * (j + 1); ++of_column) {
            int row = ja[of_column];
            if (column == row) {
                value += a[of_row] * inverse_mass(column / 3) * a[of_column];
            }
        }
    }
    if (i == j) {
        value += softness * edges[i].z;
    }
    if (value != 0.0) {
        uint at = atomicAdd(row_count[i], 1u);
        coo[ROW_SLOTS * uint(i) + at] = vec4(i, j, value, 0.0);
    }
}
