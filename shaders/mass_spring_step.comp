// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// One substep of the mass-spring mode: forces and update in one pass, BLOCK x BLOCK nodes an
// invocation. A spring inside the block is evaluated once for both its ends.
// HAS_HELD 1: the pass records what pinned nodes are driven with.

#define CHANGES_LOW_PARTS_ONCE

#include "lattice.glsl"
#include "state_in.glsl"
#include "state_out.glsl"
#include "spring_law.glsl"
#include "applied_acceleration.glsl"
#include "symplectic_euler.glsl"
#if HAS_RIGIDITY
#include "block_bending.glsl"

uniform float bending[2];  // [N/m] along a row, along a column
#endif
#if HAS_BENDING_DAMPING
#include "bending_damping.glsl"

uniform float bending_damping;  // [s]
#endif

#if HAS_HELD
#include "held.glsl"
#include "node_force.glsl"
#endif
#if HAS_CONTACT
#include "block_bound.glsl"
#endif

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

#define REACH HALO
#define TILE (BLOCK + 2 * REACH)
#include "block_edges.glsl"

vec4 position[TILE][TILE];
#if HAS_DAMPING || HAS_BENDING_DAMPING
vec3 velocity[TILE][TILE];
#endif
vec3 force[TILE][TILE];

void add_spring(int row, int col, int drow, int dcol, int edge, int rest) {
    vec4 from = position[row][col];
    vec4 to = position[row + drow][col + dcol];
#if HAS_DAMPING
    vec3 dv = velocity[row + drow][col + dcol] - velocity[row][col];
#else
    vec3 dv = vec3(0.0);
#endif
    vec3 d = to.xyz - from.xyz;
    vec3 f = spring_force(d, dv, edge_share(from, to, edge), rest);
    force[row][col] += f;
    force[row + drow][col + dcol] -= f;
}

#if HAS_BENDING_DAMPING
vec4 brake[TILE][TILE];

// By all lines of one direction; each is found once for three nodes.
#define ADD_BENDING_BRAKES(DROW, DCOL) \
    FOR_BENT(DROW, DCOL) { \
        brake[row][col] = line_brake( \
            position[row - DROW][col - DCOL], position[row][col], \
            position[row + DROW][col + DCOL], velocity[row - DROW][col - DCOL], \
            velocity[row][col], velocity[row + DROW][col + DCOL], DROW); \
    } \
    FOR_BENT(0, 0) { \
        force[row][col] -= bending_damping * bending[DROW] * braked( \
            brake[row - DROW][col - DCOL], brake[row][col], brake[row + DROW][col + DCOL]); \
    }
#endif

// Every spring of one direction with an end in the block.
#define ADD_SPRINGS(FIRST, EDGE, DROW, DCOL, FAMILY, REST) \
    FOR_BLOCK_EDGES(DROW, DCOL, add_spring(row, col, DROW, DCOL, EDGE, REST))

void main() {
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * BLOCK;
    if (first.x >= COLS || first.y >= ROWS) {
        return;
    }
    FOR_TILE {
        int index = node_index(first.y + row - HALO, first.x + col - HALO);
        position[row][col] = load_position(index);
#if HAS_DAMPING || HAS_BENDING_DAMPING
        velocity[row][col] = load_velocity(index).xyz;
#endif
        force[row][col] = vec3(0.0);
    }
    EACH_EDGE(ADD_SPRINGS, first)
#if HAS_RIGIDITY
    vec3 resisted[TILE][TILE];
    FIND_BENDING(resisted, position, position, bending)
    FOR_BENT(0, 0) {
        force[row][col] -= resisted[row][col];
    }
#endif
#if HAS_BENDING_DAMPING
    ADD_BENDING_BRAKES(0, 1)
    ADD_BENDING_BRAKES(1, 0)
#endif
#if HAS_CONTACT
    Bound bound = Bound(vec3(1e30), vec3(-1e30), 0.0);
    FOR_BLOCK {
        add_place(bound, position[row][col]);
    }
#endif
#if HAS_HELD
    uint pins = 0u;  // a bit for each node of the block
#endif
    FOR_BLOCK {
        int index = node_index(first.y + row - HALO, first.x + col - HALO);
        vec4 v = load_velocity(index);
#if HAS_HELD
        uint bit = 1u << uint((row - HALO) * BLOCK + col - HALO);
        pins |= is_held_by_pin(position[row][col], v) ? bit : 0u;
#endif
        v.xyz = next_velocity(
            index, v, force[row][col], applied_acceleration(index));
        // Both w stand in every pair of buffers; software devices store number by number.
        velocity_out[index].xyz = v.xyz;
        position_out[index].xyz = next_position(index, position[row][col].xyz, v.xyz);
#if HAS_CONTACT
        add_speed(bound, v.xyz);
#endif
    }
#if HAS_CONTACT
    list_if_near(bound, first);
#endif
#if HAS_HELD
    // Their force is found anew: kept for all nodes until here, it takes a fifth of the pass.
    // As in solver/contact.comp, software would run the body of a branch for every block.
    for (uint asks = pins; asks != 0u; asks &= asks - 1u) {
        int place = findLSB(asks);
        int index = node_index(first.y + place / BLOCK, first.x + place % BLOCK);
        vec3 driven = mass_share(load_position(index)) * applied_acceleration(index)
            + inverse_mass * node_force(index);
        held[held_entry(index)] = vec4(kick * driven, kick);
    }
#endif
}
