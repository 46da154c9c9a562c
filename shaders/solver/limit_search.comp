// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// A solve linearises the law of each edge at the expected length. This measures the error along the
// step to the solution, where edges reach or leave their limits. Sums over all nodes and edges: the
// curvature of the linearised energy along the step, the difference of the true slope at share of
// the step, and the squared error of the tensions there.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "state_in.glsl"
#include "solver/state_index.glsl"
#include "solver/cloth_tile.glsl"
#include "solver/cloth_edges.glsl"
#include "solver/edge_law.glsl"
#include "solver/foreseen_length.glsl"
#if HAS_RIGIDITY
#include "block_bending.glsl"

uniform float bending_weight[2];
#endif
#if HAS_BENDING_DAMPING
#include "solver/bent_lines.glsl"
#endif

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

#include "solver/partial_sums.glsl"

uniform int start_field;  // where the solve began, of which
uniform float guess;      // this share
uniform float share;      // of the way to its solution
uniform float to_come;    // of what the velocities move nodes by: 0 in a further solve

// A loop for each direction: both in one take llvmpipe seconds to compile.
#define ADD_BENT(DROW, DCOL) \
    FOR_BLOCK { \
        vec3 bent = second_difference( \
            1.0, way[row - DROW][col - DCOL], way[row][col], way[row + DROW][col + DCOL]); \
        sums.x += bending_weight[DROW] * BENT_SHARE(node, row, col, DROW, DCOL) \
            * dot(bent, bent); \
    }
#define ADD_BENT_SPEED(DROW, DCOL) \
    FOR_BLOCK { \
        float speed = bent_speed( \
            load_system(cloth_entry(BENT_LINES + DROW, tile_index(first, row, col))), \
            way[row - DROW][col - DCOL], way[row][col], way[row + DROW][col + DCOL]); \
        sums.x += speed * speed; \
    }

vec3 velocity[TILE][TILE];
vec3 start[TILE][TILE];
vec3 way[TILE][TILE];
vec4 tension[TILE][TILE];  // found last
vec3 sums;

void look(int row, int col, int drow, int dcol, int edge, int family, int rest) {
    vec4 from = node[row][col];
    vec4 to = node[row + drow][col + dcol];
    float edge_part = moving_share(from, to, edge);
    if (!is_in_block(row, col) || edge_part == 0.0) {
        return;
    }
    vec3 d = from.xyz - to.xyz;
    float square = max(dot(d, d), 1e-20);
    float inverse_length = inversesqrt(square);
    vec3 n = inverse_length * d;
    vec3 u = velocity[row][col] - velocity[row + drow][col + dcol];
    vec3 w = way[row][col] - way[row + drow][col + dcol];
    float begun = foreseen_length(square * inverse_length, n, to_come * u)
        + substep * dot(n, start[row][col] - start[row + drow][col + dcol]);
    float opened = dot(n, w);
    float missing = 0.0;
    float slope = 0.0;
    // Bend edges come to no limits.
    if (family != BEND) {
        float pull = tension[row][col][SHORT_SLOT(edge)] / edge_part;
        float judged = judged_length(begun, pull, dot(n, u), family, rest);
        float l = begun + substep * share * opened;
        Past straight = past_limits(l, judged, family, rest);
        Past bent = past_limits(l, l, family, rest);
        missing = edge_part * substep * limit_stiffness[rest]
            * (bent.amount - straight.amount);
        slope = edge_part
            * (edge_stiffness[rest] + limit_stiffness[rest] * bent.slope);
    }
    float weight = weight_along(row, col, edge) * square;
    sums += vec3(
        weight * opened * opened + weight_across(row, col, edge) * dot(w, w),
        missing * opened,
        missing * missing / (1.0 + substep * substep * slope));
}

void main() {
    ivec2 first = first_of_block();
    sums = vec3(0.0);
    if (in_cloth(first)) {
        load_edges(first);
        FOR_TILE {
            ivec2 at = first + ivec2(col, row) - REACH;
            int entry = tile_index(first, row, col);
            velocity[row][col] = load_velocity(state_index(at.y, at.x)).xyz;
            tension[row][col] = load_system(cloth_entry(TENSION, entry));
            float moves = is_free(node[row][col]) ? 1.0 : 0.0;
            start[row][col] = moves * guess * load_vector(cloth_entry(start_field, entry));
            way[row][col] = load_vector(cloth_entry(SOLUTION, entry)) - start[row][col];
        }
        FOR_CLOTH_EDGES(look)
        FOR_BLOCK {
            sums.x += mass_share(node[row][col]) * dot(way[row][col], way[row][col]);
        }
#if HAS_RIGIDITY
        ADD_BENT(0, 1)
        ADD_BENT(1, 0)
#endif
#if HAS_BENDING_DAMPING
        ADD_BENT_SPEED(0, 1)
        ADD_BENT_SPEED(1, 0)
#endif
    }
    store_sums(sums);
}
