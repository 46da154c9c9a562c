// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// What a solve drives pinned nodes with: the right side that they would have, less the matrix
// times the solution. Their neighbours get the opposite of what edges and bending have in it, so
// momentum is exact whatever the solve leaves. To be run before find_tension.comp.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/cloth_product.glsl"
#include "state_in.glsl"
#include "solver/state_index.glsl"
#include "applied_acceleration.glsl"
#include "held.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float substep;       // [s]
uniform float kick;          // [s] that what is applied acts for
uniform float to_come;       // 0 in a further solve: it finds what tensions lack only
#if HAS_RIGIDITY
uniform float bending_rate[2];  // [1/s2] c along a row and along a column, over the node mass
#endif
#if HAS_BENDING_DAMPING
uniform float damping_weight[2];  // along a row and along a column, over the node mass
#endif

vec4 begun[TILE][TILE];
vec4 found[TILE][TILE];
#if HAS_BEND
vec4 bend_tension[TILE][TILE];
#endif

void pull(int row, int col, int drow, int dcol, int edge, int family, int rest) {
    vec3 d = node[row][col].xyz - node[row + drow][col + dcol].xyz;
    vec3 n = inversesqrt(max(dot(d, d), 1e-20)) * d;
    bool moves = moving_share(node[row][col], node[row + drow][col + dcol], edge) > 0.0;
#if HAS_BEND
    vec2 tensions = edge >= EDGE_TWO_ROW
        ? vec2(bend_tension[row][col][LONG_SLOT(edge) + 2],
               bend_tension[row][col][LONG_SLOT(edge)])
        : vec2(begun[row][col][SHORT_SLOT(edge)], found[row][col][SHORT_SLOT(edge)]);
#else
    vec2 tensions = vec2(begun[row][col][SHORT_SLOT(edge)], found[row][col][SHORT_SLOT(edge)]);
#endif
    vec3 impulse = (moves ? substep * (tensions.x - (1.0 - to_come) * tensions.y) : 0.0) * n;
    product[row][col] += impulse;
    product[row + drow][col + dcol] -= impulse;
}

bool is_pin(ivec2 first, int row, int col) {
    return load_system(cloth_entry(NODE, tile_index(first, row, col))).w < 0.0;
}

void add_pulls(ivec2 first) {
    FOR_TILE {
        int entry = tile_index(first, row, col);
        begun[row][col] = load_system(cloth_entry(BEGUN, entry));
        found[row][col] = load_system(cloth_entry(TENSION, entry));
#if HAS_BEND
        bend_tension[row][col] = load_system(cloth_entry(BEND_TENSION, entry));
#endif
    }
    FOR_CLOTH_EDGES(pull)
}

void drive(ivec2 first) {
    load_edges(first);
    load_values(first, SOLUTION);
    make_whole_product(first);
    add_pulls(first);
#if HAS_RIGIDITY
    vec3 resisted[TILE][TILE];
    FIND_BENDING(resisted, node, node, bending_rate)
#endif
    FOR_BLOCK {
        if (is_pin(first, row, col)) {
            ivec2 at = first + ivec2(col, row) - REACH;
            int index = state_index(at.y, at.x);
            // The solution is 0 at a pin, so the product is that of its edges alone.
            vec3 driven = -product[row][col]
                + to_come * kick * mass_share(node[row][col]) * applied_acceleration(index);
#if HAS_RIGIDITY
            driven -= to_come * kick * resisted[row][col];
#endif
#if HAS_BENDING_DAMPING
            for (int direction = 0; direction < 2; ++direction) {
                int stride = direction == 0 ? 1 : state_pitch;
                driven -= to_come * damping_weight[direction] * BENDING_BRAKE(index, stride);
            }
#endif
            int entry = held_entry(index);
            vec3 before = to_come > 0.0 ? vec3(0.0) : held[entry].xyz;
            held[entry] = vec4(before + driven, kick);
        }
    }
}

void main() {
    ivec2 first = first_of_block();
    if (!in_cloth(first)) {
        return;
    }
    bool holds = false;
    FOR_BLOCK {
        holds = holds || is_pin(first, row, col);
    }
    // As in limit/edges.comp, software would run the body of a branch for every block.
    for (uint asks = holds ? 1u : 0u; asks != 0u; asks &= asks - 1u) {
        drive(first);
    }
}
