// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Several substeps of the mass-spring mode in one dispatch, under a load that stays equal: a
// workgroup keeps a whole cloth of up to TILE_SIDE x TILE_SIDE nodes in shared memory, one node an
// invocation.
// Forces are summed in the order of mass_spring_step.comp, so that both have the same bits.

#include "lattice.glsl"
#include "state_in.glsl"
#include "state_out.glsl"
#include "spring_law.glsl"
#include "symplectic_euler.glsl"

layout(local_size_x = TILE_SIDE, local_size_y = TILE_SIDE) in;

uniform vec3 acceleration;  // [m/s2]
uniform ivec2 stack;        // rows of a cloth, and from one cloth to the next
uniform int substeps;

shared vec4 position[TILE_SIDE * TILE_SIDE];
shared vec4 velocity[TILE_SIDE * TILE_SIDE];

// Force on the node at the first place from its spring to the one at the second [N].
vec3 force_between(int from, int to, int edge, int rest) {
    vec4 tail = position[from];
    vec4 head = position[to];
#if HAS_DAMPING
    vec3 dv = velocity[to].xyz - velocity[from].xyz;
#else
    vec3 dv = vec3(0.0);
#endif
    return spring_force(head.xyz - tail.xyz, dv, edge_share(tail, head, edge), rest);
}

// The spring of one direction that ends at a node, and the one that begins there.
#define ADD_SPRINGS(FORCE, EDGE, DROW, DCOL, FAMILY, REST) \
    if (local.y >= DROW && local.x - DCOL >= 0 && local.x - DCOL < TILE_SIDE) { \
        FORCE -= force_between(place - (DROW) * TILE_SIDE - (DCOL), place, EDGE, REST); \
    } \
    if (local.y + DROW < TILE_SIDE && local.x + DCOL >= 0 && local.x + DCOL < TILE_SIDE) { \
        FORCE += force_between(place, place + (DROW) * TILE_SIDE + (DCOL), EDGE, REST); \
    }

void main() {
    ivec2 local = ivec2(gl_LocalInvocationID.xy);
    int place = local.y * TILE_SIDE + local.x;
    int index = node_index(int(gl_WorkGroupID.y) * stack.y + local.y, local.x);
    bool is_node = local.x < COLS && local.y < stack.x;
    position[place] = is_node ? load_position(index) : vec4(0.0);
    velocity[place] = is_node ? load_velocity(index) : vec4(0.0);
    barrier();
    for (int count = 0; count < substeps; ++count) {
        vec3 force = vec3(0.0);
        EACH_EDGE(ADD_SPRINGS, force)
        vec3 next = next_velocity(index, velocity[place], force, acceleration);
        vec3 moved = next_position(index, position[place].xyz, next);
        barrier();
        velocity[place].xyz = next;
        position[place].xyz = moved;
        barrier();
    }
    if (is_node) {
        velocity_out[index].xyz = velocity[place].xyz;
        position_out[index].xyz = position[place].xyz;
    }
}
