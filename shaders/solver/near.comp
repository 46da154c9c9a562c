// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// List the nodes that contact.comp decides about: few of all, and it does much with each.
// STAGE BEGIN: before the first solve, nodes that may come to a collider at the expected velocity.
// For all others, contact, friction and impulses of the last substep are set to zero.
// STAGE AFTER: after a solve, nodes that touch a collider, were let go by one, or may come to one
// at the velocity that it has led to.

#define BEGIN 0
#define AFTER 1

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/state_index.glsl"
#include "solver/free_directions.glsl"
#include "solver/near_list.glsl"
#include "state_in.glsl"
#if STAGE == BEGIN
#include "applied_acceleration.glsl"
#endif
#include "collider_bounds.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float substep;        // [s]
#if STAGE == BEGIN
uniform float kick;           // [s] that what is applied acts for
uniform float guess;          // share of the last change that is expected; 0: none known
#else
uniform float most_unsolved;  // [m] that a node may be moved by without another solve
#endif

void list(int row, int col) {
    uint place = atomicAdd(near_count, 1u);
    near_nodes[place] = uint(row * COLS + col);
    atomicAdd(near_groups_x, place % NEAR_LOCAL == 0u ? 1u : 0u);
}

#if STAGE == BEGIN
// Let a node begin the substep that touches nothing; change: of its velocity in the last one.
void begin_free(int index, vec3 change) {
    bool knows_change = guess != 0.0 || change == vec3(0.0);
    bool was_free = load_contact(index).w == 0.0
        && load_entry(cloth_entry(REACTION, index)) == vec4(0.0)
        && load_vector(cloth_entry(GIVEN, index)) == vec3(0.0);
    // Software runs the body of a branch for nodes that do not take it.
    for (uint asks = was_free && knows_change ? 0u : 1u; asks != 0u; asks &= asks - 1u) {
        system_data[cloth_entry(CONTACT, index)] = vec4(0.0);
        system_data[cloth_entry(GRIP, index)] = vec4(0.0);
        vectors[cloth_entry(REACTION, index)] = vec4(0.0);
        store_vector(cloth_entry(GIVEN, index), vec3(0.0));
        store_vector(cloth_entry(CHANGE, index), guess != 0.0 ? change : vec3(0.0));
    }
}
#endif

void main() {
    int row = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    int at = state_index(row, col);
    int index = node_index(row, col);
    vec4 v = load_velocity(at);
#if STAGE == BEGIN
    vec3 x = load_position(at).xyz;
    store_vector(cloth_entry(BEGIN_POSITION, index), x);
    store_vector(cloth_entry(BEGIN_VELOCITY, index), v.xyz);
    vec3 change = load_vector(cloth_entry(CHANGE, index));
    vec3 towards = v.xyz + guess * change + kick * applied_acceleration(at);
    // NaN counts as near, so that the node is listed.
    bool is_near = (near_bodies(x, 0.0, substep * length(towards)) & NODE_COLLIDERS) != 0u;
    if (v.w > 0.0 && is_near) {
        list(row, col);
    } else if (v.w > 0.0) {
        begin_free(index, change);
    }
#else
    bool touches = load_contact(index).w > 0.0
        || load_vector(cloth_entry(GIVEN, index)) != vec3(0.0);
    vec3 begin = load_vector(cloth_entry(BEGIN_POSITION, index));
    // As above.
    bool is_near = near_bodies(begin, 0.0, substep * length(v.xyz) + most_unsolved) != 0u;
    if (v.w > 0.0 && (touches || is_near)) {
        list(row, col);
    }
#endif
}
