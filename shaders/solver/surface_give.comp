// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The impulses of contacts with thin colliders after a solve that has been applied, what the next one
// begins with, and whether it is due: one workgroup.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/state_index.glsl"
#include "state_in.glsl"
#include "solver/free_directions.glsl"
#include "contact.glsl"
#include "contact_record.glsl"

layout(local_size_x = SURFACE_LOCAL) in;

uniform float substep;        // [s]
uniform float most_unsolved;  // [m] that a point may be moved by without another solve

#define KNOWS_COLLIDERS
#include "solver/surface_contacts.glsl"

// Leave marks if a point is missed by this way, and if it is held that was not, or not any more.
void ask(float way, bool turns) {
    if (way > most_unsolved) {
        note_change();
        if (turns) {
            note_turn();
        }
    }
}

void give(int place) {
    SurfaceContact contact = surface_contacts[place];
    int collider = int(contact.weights.w);
    vec3 normal = contact.normal.xyz;
    ivec3 nodes = nodes_of(place);
    vec3 u = vec3(0.0), x = vec3(0.0), change = vec3(0.0);
    for (int i = 0; i < nodes_in(row_of(place)); ++i) {
        int index = nodes[i];
        int at = state_index(index / PITCH - HALO, index % PITCH - HALO);
        u += contact.weights[i] * load_velocity(at).xyz;
        x += contact.weights[i] * load_vector(cloth_entry(BEGIN_POSITION, index));
        change += contact.weights[i] * load_vector(cloth_entry(SOLUTION, index));
    }
    u -= surface_velocity(collider, x);
    vec3 impulse = contact.begun.xyz - resistance(contact, change);
    float pressed = dot(impulse, normal);
    vec3 friction = impulse - pressed * normal;
    bool presses = contact.impulse.w > 0.0;
    float lacking = -dot(u, normal) - max(contact.normal.w, 0.0) / substep;
    vec3 slid = u - dot(u, normal) * normal;
    contact.given.xyz = impulse;
    contact.impulse.xyz = max(pressed, 0.0) * normal + friction;
    float most = most_friction(contact);
    float size = length(friction);
    contact.impulse.xyz -= size > most ? (1.0 - most / size) * friction : vec3(0.0);
    // An impulse moves the point by this, if its neighbours stay.
    float way = substep * STIFFNESS / contact.given.w;
    if (!presses) {
        ask(substep * lacking, true);
    } else if (pressed < 0.0) {
        ask(-way * pressed, true);
    } else {
        ask(substep * abs(lacking), false);
    }
    // By what friction would be moved, and by how much it is off, the point moves.
    vec3 pull = pull_at(contact, u);
    vec3 by_law = min(most / max(length(pull), 1e-30), 1.0) * pull;
    float off = substep * STIFFNESS / contact.sticking.x * length(by_law - friction);
    ask(min(off, substep * length(slid)), most == 0.0 && size > 0.0);
    surface_contacts[place] = contact;
}

void add_up(int index) {
    SurfaceHold node = surface_holds[index];
    vec3 sum = vec3(0.0);
    for (int i = node.first; i < node.first + node.count; ++i) {
        SurfaceContact contact = surface_contacts[contact_of_node(i)];
        sum += weight_of_node(i, contact) * contact.given.xyz;
    }
    // reaction.comp takes for a reaction of the node all that the right side has not.
    if (load_contact(index).w > 0.0) {
        float share = mass_share(load_system(cloth_entry(NODE, index)));
        vec3 reaction = load_vector(cloth_entry(REACTION, index));
        store_vector(cloth_entry(REACTION, index), reaction - (sum - node.given) / share);
    }
    surface_holds[index].given = sum;
}

void main() {
    for (uint i = gl_LocalInvocationID.x; i < listed_contacts; i += SURFACE_LOCAL) {
        give(int(surface_lists[uint(CONTACTS_AT) + i]));
    }
    memoryBarrierBuffer();
    barrier();
    for (uint i = gl_LocalInvocationID.x; i < held_nodes; i += SURFACE_LOCAL) {
        add_up(int(surface_lists[uint(HELD_AT) + i]));
    }
}
