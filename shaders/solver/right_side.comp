// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Set up a solve of the step, over the node mass: the right side [m/s], and the stiffness of each
// edge along and across its direction, which is frozen at the current positions. The tension of an
// edge is that of its law at the length that the velocities lead to, with the limit that acts at
// the length expected of the solution.
// The first solve starts from the velocities before; with FORESEES_TURN the length of an edge
// includes the part by its rotation. Later solves start from moved nodes and correct the tensions
// to the law; they are omitted where the error is below the rounding of lengths. One program does
// both, since each takes llvmpipe a second to compile.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "state_in.glsl"
#include "solver/state_index.glsl"
#include "solver/cloth_tile.glsl"
#include "solver/edge_law.glsl"
#include "solver/edge_slots.glsl"
#include "solver/foreseen_length.glsl"
#define SCALARS_ACCESS
#include "solver/scalars.glsl"
#include "applied_acceleration.glsl"
#include "solver/free_directions.glsl"
#if HAS_RIGIDITY
#include "block_bending.glsl"

uniform float bending_rate[2];  // [1/s2] c along a row and along a column, over the node mass
#endif

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float kick;          // [s] that what is applied acts for
uniform int start_field;     // a change of velocity, of which
uniform float guess;         // this share is expected now
uniform float geometric;     // beta of the geometric mass term
#if HAS_LAYERS
// Impulses of layers of the cloth that the solve is to include [m/s of a node amid the cloth].
layout(binding = SELF_DRIVEN) uniform samplerBuffer driven;
uniform float driven_share;  // 1, or 0 for none
#endif
uniform float to_come;       // of what is applied, and velocities move nodes by: 0 in a further solve

vec3 velocity[TILE][TILE];
vec3 expected[TILE][TILE];   // change of velocity
vec3 change[TILE][TILE];
vec4 tension[TILE][TILE];    // found last
vec4 begun[TILE][TILE];
bool is_off_here = false;

// A coordinate is rounded by 2^-24 of it at most; of those of both ends some three times that comes
// together in a length.
#define ROUNDED 1.8e-7

float rounding_of_length(vec3 from, vec3 to) {
    vec3 far = max(abs(from), abs(to));
    return ROUNDED * max(max(far.x, far.y), far.z);
}

#if HAS_CONTACT
// If both ends of an edge touch a surface, its tension is kept while its length changes by less
// than rounding: in a hard edge, the tension by rounding is as large as weak friction and would
// make nodes stick or slide at random.
float touches[TILE][TILE];  // 1 where a node does, else 0
#endif

#if HAS_BEND
vec4 bend_tension[TILE][TILE];
vec4 bend_weight[TILE][TILE];
#endif

float found_tension(int row, int col, int edge) {
#if HAS_BEND
    if (edge >= EDGE_TWO_ROW) {
        return bend_tension[row][col][LONG_SLOT(edge)];
    }
#endif
    return tension[row][col][SHORT_SLOT(edge)];
}

void store_edge(int row, int col, int edge, float begun_here, float along_here, float across_here) {
#if HAS_BEND
    if (edge >= EDGE_TWO_ROW) {
        bend_tension[row][col][LONG_SLOT(edge) + 2] = begun_here;
        bend_weight[row][col][LONG_SLOT(edge)] = along_here;
        bend_weight[row][col][LONG_SLOT(edge) + 2] = across_here;
        return;
    }
#endif
    begun[row][col][SHORT_SLOT(edge)] = begun_here;
    along[row][col][SHORT_SLOT(edge)] = along_here;
    across[row][col][SHORT_SLOT(edge)] = across_here;
}

void add_edge(int row, int col, int drow, int dcol, int edge, int family, int rest) {
    vec4 from = node[row][col];
    vec4 to = node[row + drow][col + dcol];
    float share = moving_share(from, to, edge);
    vec3 d = from.xyz - to.xyz;
    float square = max(dot(d, d), 1e-20);
    float inverse_length = inversesqrt(square);
    float l = square * inverse_length;
    vec3 n = inverse_length * d;
    vec3 u = velocity[row][col] - velocity[row + drow][col + dcol];
    float ahead = foreseen_length(l, n, to_come * u);
    float rate = dot(n, u);
    float found = found_tension(row, col, edge);
    // The law is that of a whole line.
    float of_line = found;
#if HAS_CELLS
    of_line = share > 0.0 ? found / share : 0.0;
#endif
    // Edges come to their limits in the step, and leave them.
    float judged = judged_length(
        ahead + substep * dot(n, expected[row][col] - expected[row + drow][col + dcol]),
        of_line, rate, family, rest);
    Pull pull = pull_at(ahead, judged, rate, family, rest);
#if HAS_CONTACT
    float rounded = touches[row][col] * touches[row + drow][col + dcol]
        * pull.slope * rounding_of_length(from.xyz, to.xyz);
    pull.tension += clamp(of_line + pull.slope * (ahead - l) - pull.tension, -rounded, rounded);
#endif
    float tension_here = share * pull.tension;
    float missing = tension_here - (1.0 - to_come) * found;
    is_off_here = is_off_here || is_in_block(row, col)
        && abs(missing) > share * pull.slope * rounding_of_length(from.xyz, to.xyz);
    float sideways = (share > 0.0 ? 1.0 : 0.0)
        * geometric * substep * substep * max(found, 0.0) * inverse_length;
    float weight = share * substep * (substep * pull.slope + edge_damping[rest]);
    if (is_in_block(row, col)) {
        store_edge(row, col, edge, tension_here, (weight - sideways) / square, sideways);
    }
    vec3 impulse = (substep * missing) * n;
    change[row][col] -= impulse;
    change[row + drow][col + dcol] += impulse;
}

void main() {
    ivec2 first = first_of_block();
    if (!in_cloth(first)) {
        return;
    }
    FOR_TILE {
        ivec2 at = first + ivec2(col, row) - REACH;
        int index = state_index(at.y, at.x);
        int entry = tile_index(first, row, col);
        vec4 position = load_position(index);
        vec4 v = load_velocity(index);
        node[row][col] = vec4(position.xyz, position.w * (v.w > 0.0 ? 1.0 : -1.0));
        velocity[row][col] = v.xyz;
        expected[row][col] = guess * load_vector(cloth_entry(start_field, entry));
        change[row][col] = vec3(0.0);
        along[row][col] = across[row][col] = begun[row][col] = vec4(0.0);
#if HAS_CONTACT
        touches[row][col] = min(load_contact(entry).w, 1.0);
#endif
        tension[row][col] = load_system(cloth_entry(TENSION, entry));
#if HAS_BEND
        bend_tension[row][col] = load_system(cloth_entry(BEND_TENSION, entry));
#endif
    }
    FOR_CLOTH_EDGES(add_edge)
    // Asked first: on a GPU, atomics of all invocations on one word wait for each other.
    if (is_off_here && is_off == 0u) {
        atomicOr(is_off, floatBitsToUint(1.0));
    }
#if HAS_RIGIDITY
    vec3 resisted[TILE][TILE];
    FIND_BENDING(resisted, node, node, bending_rate)
#endif
    FOR_BLOCK {
        ivec2 at = first + ivec2(col, row) - REACH;
        int entry = tile_index(first, row, col);
        vec3 total = vec3(0.0);
        if (is_free(node[row][col])) {
            vec3 applied = applied_acceleration(state_index(at.y, at.x));
#if HAS_RIGIDITY
            // As where the step begins; the matrix makes it the mean of before and after.
            applied -= resisted[row][col] / mass_share(node[row][col]);
#endif
            total = change[row][col] + to_come * kick * mass_share(node[row][col]) * applied;
#if HAS_LAYERS
            total += driven_share * texelFetch(driven, state_index(at.y, at.x)).xyz;
#endif
        }
        store_vector(cloth_entry(RESIDUAL, entry), total);
        system_data[cloth_entry(NODE, entry)] = node[row][col];
        system_data[cloth_entry(ALONG, entry)] = along[row][col];
        system_data[cloth_entry(ACROSS, entry)] = across[row][col];
        system_data[cloth_entry(BEGUN, entry)] = begun[row][col];
#if HAS_BEND
        system_data[cloth_entry(BEND_WEIGHT, entry)] = bend_weight[row][col];
        system_data[cloth_entry(BEND_TENSION, entry)] = bend_tension[row][col];
#endif
    }
}
