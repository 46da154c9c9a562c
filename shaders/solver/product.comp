// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The matrix times the preconditioned residual, and the part of each block in two scalar products.
// REDUCES: the workgroup that ends last adds them up; in an order of its own, whichever it is.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/cloth_product.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

#if REDUCES
// The last workgroup to end reads what all have stored.
#define SUMS_ACCESS coherent
#endif
#include "solver/partial_sums.glsl"
#if REDUCES
#define LOAD_SUMS(i) partial_sums[i].xyz
#include "solver/reduction.glsl"

shared bool is_last;
#endif

void main() {
    ivec2 first = first_of_block();
    vec3 sums = vec3(0.0);
    if (in_cloth(first)) {
        load_edges(first);
        load_values(first, PRECONDITIONED);
        make_product(first);
        FOR_BLOCK {
            int index = tile_index(first, row, col);
            vec3 residual = load_vector(cloth_entry(RESIDUAL, index));
            store_vector(cloth_entry(PRODUCT, index), product[row][col]);
            vec3 solution = load_vector(cloth_entry(SOLUTION, index));
            sums += vec3(
                dot(residual, value[row][col]), dot(product[row][col], value[row][col]),
                dot(solution, solution));
        }
    }
    store_sums(sums);
#if REDUCES
    int at = int(gl_LocalInvocationIndex);
    if (at == 0) {
        memoryBarrierBuffer();
        uint count = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
        is_last = atomicAdd(finished_groups, 1u) + 1u == count;
    }
    barrier();
    if (is_last) {
        memoryBarrierBuffer();
        reduce(at);
        finished_groups = 0u;
    }
#endif
}
