// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Find the contacts of nodes, edges and faces with thin colliders, from where nodes are as the substep
// begins.
// STAGE BEGIN: before the first solve, by the expected velocities.
// STAGE AGAIN: after a solve, those that its velocities enter besides.

#define BEGIN 0
#define AGAIN 1

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/state_index.glsl"
#include "state_in.glsl"
#if STAGE == BEGIN
#include "applied_acceleration.glsl"
#endif
#include "contact.glsl"
#include "contact_record.glsl"
#include "near_surface.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float substep;        // [s]
#if STAGE == BEGIN
uniform float kick;           // [s] that what is applied acts for
uniform float guess;          // share of the last change that is expected; 0: none known
#endif
uniform float most_unsolved;  // [m] that a point may enter a collider by without another solve

int at_of(int index) { return state_index(index / PITCH - HALO, index % PITCH - HALO); }

vec4 load_begin(int index) {
    return vec4(
        load_vector(cloth_entry(BEGIN_POSITION, index)), load_position(at_of(index)).w);
}

vec3 load_speed(int index) {
    int at = at_of(index);
    vec4 v = load_velocity(at);
#if STAGE == BEGIN
    v.xyz += v.w > 0.0 ? guess * load_vector(cloth_entry(CHANGE, index))
        + kick * applied_acceleration(at) : vec3(0.0);
#endif
    return v.xyz;
}

vec3 load_end(int index) { return load_begin(index).xyz + substep * load_speed(index); }

#include "surface_find.glsl"
#define KNOWS_NODES 0
#include "solver/surface_contacts.glsl"

// As edge_row and face_row, for a node alone.
SurfaceRow node_row(int collider, int index) {
    vec3 x = load_begin(index).xyz;
    vec4 near = gap_at(collider, x);
    vec3 v = load_speed(index);
    float around = rounding(x, collider);
    float way = substep * length(v - surface_velocity(collider, x));
    bool is_near = near.w < way + around;
    // The plane along a curved surface reaches beyond it.
    if (is_near && !has_held && near.w > around && 2.0 * way < collider_thickness[collider]) {
        is_near = gap_at_end(collider, x + substep * v, substep).w < 0.0;
    }
    return is_near ? SurfaceRow(
        near, vec4(0.0, 0.0, 0.0, 1.0), vec4(1.0, 0.0, 0.0, float(collider))) : no_row();
}

// Whether there is what a row is of, and something of it can move.
bool is_there(int index, int row) {
    return row == NODE_ROW ? load_velocity(at_of(index)).w > 0.0 : owns(index, row);
}

// Whether a point of the velocities that nodes have is within the collider as the substep ends.
bool enters(SurfaceRow found, ivec3 nodes, int collider) {
    vec3 u = vec3(0.0), x = vec3(0.0);
    for (int i = 0; i < 3; ++i) {
        u += found.weights[i] * load_speed(nodes[i]);
        x += found.weights[i] * load_begin(nodes[i]).xyz;
    }
    u -= surface_velocity(collider, x);
    return dot(u, found.normal.xyz) * substep + max(found.normal.w, 0.0) < -most_unsolved;
}

// Find those of the rows of a node and a collider that are no contacts yet; return all as bits.
uint find_rows(int index, int body, int collider, uint known) {
    uint bits = known;
#if STAGE == BEGIN
    bits = 0u;
#endif
    for (int row = 0; row < CONTACT_ROWS; ++row) {
        uint bit = 1u << uint(row);
        int place = contact_place(body, row, index);
        bool was = (known & bit) != 0u;
        if (!is_there(index, row) || STAGE == AGAIN && was) {
            continue;
        }
        ivec3 nodes = index + contact_offsets(row);
        vec3 kept = was ? surface_contacts[place].impulse.xyz : vec3(0.0);
        has_held = kept != vec3(0.0);
        SurfaceRow found;
        if (row < SURFACE_EDGES) {
            found = edge_row(collider, nodes.x, nodes.y);
        } else if (row == NODE_ROW) {
            found = node_row(collider, index);
        } else {
            found = face_row(collider, nodes, (row - SURFACE_EDGES) % SURFACE_TIPS);
        }
        if (found.impulse.w == 0.0 || STAGE == AGAIN && !enters(found, nodes, collider)) {
            continue;
        }
        bits |= bit;
        surface_contacts[place] = SurfaceContact(
            found.normal, found.weights, vec4(kept, 0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    }
    return bits;
}

void main() {
    int row = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    int index = node_index(row, col);
    is_at_end = false;
    vec3 x = load_begin(index).xyz;
    uint some = near_surface(SURFACE_COLLIDERS, x, load_speed(index), substep);
    uint near = 0u;
    // A loop that ends at once costs software less than a branch, whose body it runs.
    for (uint asks = some != 0u ? 1u : 0u; asks != 0u; asks &= asks - 1u) {
        near = colliders_near_cell(index, some);
    }
    uint bodies = SURFACE_COLLIDERS;
    for (int body = 0; body < THIN_COLLIDERS; ++body) {
        int collider = findLSB(bodies);
        bodies &= bodies - 1u;
        uint known = surface_lists[body * STORED + index];
        uint bits = STAGE == BEGIN ? 0u : known;
        for (uint asks = near >> uint(collider) & 1u; asks != 0u; asks &= asks - 1u) {
            bits = find_rows(index, body, collider, known);
        }
        if (bits != known) {
            surface_lists[body * STORED + index] = bits;
            atomicAdd(changed_owners, 1u);
#if STAGE == AGAIN
            note_change();
            note_turn();
#endif
        }
        if (bits != 0u) {
            atomicAdd(owners, 1u);
            note_contact();
        }
    }
}
