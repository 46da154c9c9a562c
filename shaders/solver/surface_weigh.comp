// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Which contacts with thin colliders act in a solve, what they resist with in the matrix, and their
// impulses on the right side (augmented Lagrangian): one workgroup.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/state_index.glsl"
#include "state_in.glsl"
#include "solver/cloth_edge_block.glsl"
#include "solver/free_directions.glsl"
#include "contact.glsl"

layout(local_size_x = SURFACE_LOCAL) in;

uniform float substep;  // [s]
uniform int start_field;  // a change of velocity, of which
uniform float guess;      // this share is expected
#if HAS_RIGIDITY
uniform float bending_bound[2];
#endif

#define KNOWS_COLLIDERS
#include "solver/surface_contacts.glsl"

#define ADD_BLOCK(SUM, EDGE, DROW, DCOL, FAMILY, REST) \
    SUM += edge_blocks(at, ivec2(DROW, DCOL), EDGE);

ivec2 place_on_lattice(int index) {
    return ivec2(index / PITCH - HALO, index % PITCH - HALO);
}

// What resists a change of the velocity of a node alone.
Symmetric block_of(int index) {
    ivec2 at = place_on_lattice(index);
    Symmetric sum = scaled_identity(mass_share(load_node(at)));
    EACH_EDGE(ADD_BLOCK, sum)
#if HAS_RIGIDITY
    // 6: squares of a node's parts in the three lines along each direction.
    sum += scaled_identity(6.0 * (bending_bound[0] + bending_bound[1]));
#endif
    return sum;
}

void weigh(int place) {
    SurfaceContact contact = surface_contacts[place];
    int collider = int(contact.weights.w);
    vec3 normal = contact.normal.xyz;
    ivec3 nodes = nodes_of(place);
    vec3 u = vec3(0.0), x = vec3(0.0), ahead = vec3(0.0);
    Symmetric block = Symmetric(0.0);
    for (int i = 0; i < nodes_in(row_of(place)); ++i) {
        int index = nodes[i];
        ivec2 on_lattice = place_on_lattice(index);
        int at = state_index(on_lattice.x, on_lattice.y);
        vec4 v = load_velocity(at);
        u += contact.weights[i] * v.xyz;
        x += contact.weights[i] * load_vector(cloth_entry(BEGIN_POSITION, index));
        vec3 change = guess * load_vector(cloth_entry(start_field, index));
        ahead += v.w > 0.0 ? contact.weights[i] * change : vec3(0.0);
        block += contact.weights[i] * block_of(index);
    }
    u -= surface_velocity(collider, x);
    float along = dot(normal, times(block, normal));
    contact.given.w = STIFFNESS * along;
    contact.sticking.x = STIFFNESS * (block[0].x + block[0].y + block[0].z - along);
    vec3 towards = u + ahead;
    contact.impulse.w = press_at(contact, towards) > 0.0 ? 1.0 : 0.0;
    // What slides is resisted by as much as friction is at the speed expected: that throws nothing.
    float share = min(
        most_friction(contact) / max(length(pull_at(contact, towards)), 1e-30), 1.0);
    contact.begun.w = share * contact.sticking.x;
    float room = max(contact.normal.w, 0.0) / substep;
    contact.begun.xyz = share * pull_at(contact, u) + contact.impulse.w
        * (dot(contact.impulse.xyz, normal) - contact.given.w * (dot(u, normal) + room)) * normal;
    surface_contacts[place] = contact;
}

void hold(int index) {
    SurfaceHold node = surface_holds[index];
    vec3 impulse = -node.given;
    Symmetric ground = Symmetric(0.0);
    for (int i = node.first; i < node.first + node.count; ++i) {
        SurfaceContact contact = surface_contacts[contact_of_node(i)];
        float weight = weight_of_node(i, contact);
        impulse += weight * contact.begun.xyz;
        // No less than what contacts resist with together.
        ground += weight * (scaled_identity(contact.begun.w)
            + (contact.impulse.w * contact.given.w - contact.begun.w)
            * outer_square(contact.normal.xyz));
    }
    system_data[cloth_entry(SURFACE_GROUND, index)] = vec4(ground[0], 0.0);
    system_data[cloth_entry(SURFACE_GROUND + 1, index)] = vec4(ground[1], 0.0);
    if (load_system(cloth_entry(NODE, index)).w > 0.0) {
        vec3 right = load_vector(cloth_entry(RESIDUAL, index));
        store_vector(
            cloth_entry(RESIDUAL, index), right + in_free_directions(index, impulse));
    }
}

void main() {
    for (uint i = gl_LocalInvocationID.x; i < listed_contacts; i += SURFACE_LOCAL) {
        weigh(int(surface_lists[uint(CONTACTS_AT) + i]));
    }
    memoryBarrierBuffer();
    barrier();
    for (uint i = gl_LocalInvocationID.x; i < held_nodes; i += SURFACE_LOCAL) {
        hold(int(surface_lists[uint(HELD_AT) + i]));
    }
}
