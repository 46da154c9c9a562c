// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Contacts of nodes, edges and faces with thin colliders in an implicit substep. Each has its own
// place, by collider, row and owner, which keeps its impulse from substep to substep.

#include "surface_row.glsl"

// Rows of an owner and a collider: those of edges and faces, then that of the node itself.
#define NODE_ROW SURFACE_ROWS_OF_BODY
#define CONTACT_ROWS (SURFACE_ROWS_OF_BODY + 1)

// Stiffness of a contact over that of its nodes [1].
#define STIFFNESS 20.0

struct SurfaceContact {
    vec4 normal;   // away from the collider; w: the gap less the clearance [m]
    vec4 weights;  // of the three nodes; w: the collider
    vec4 impulse;  // at the beginning of the next solve [m/s of a node]; w: 1 if it presses, else 0
    vec4 given;    // impulse in this substep; w: resistance along the normal where it presses
    vec4 begun;    // impulse in a solve that changes nothing; w: resistance across the normal
    vec4 sticking; // x: resistance across the normal if it stuck
};

layout(std430, binding = SURFACE_ROWS) buffer SurfaceContacts {
    SurfaceContact surface_contacts[];
};

layout(std430, binding = SURFACE_COUNTS) buffer SurfaceCounts {
    uint owners;           // number of owners of contacts in this substep
    uint changed_owners;   // number that changed since contacts were listed
    uint listed_contacts;
    uint held_nodes;
};

#ifndef KNOWS_NODES
#define KNOWS_NODES 1
#endif
#if KNOWS_NODES
struct SurfaceHold {
    vec3 given;  // sum of the impulses on the node in the current substep [m/s]
    int first;   // in the list of its contacts
    int count;
};

layout(std430, binding = SURFACE_NODES) buffer SurfaceHolds { SurfaceHold surface_holds[]; };
#endif

// By thin collider and owner, the rows that are contacts, one bit each; then the lists of contacts, of
// nodes, and of the contacts of each node: 4 times the place plus the index of the node in the row.
layout(std430, binding = SURFACE_LISTS) buffer SurfaceLists { uint surface_lists[]; };

#define CONTACTS_AT (THIN_COLLIDERS * STORED)
#define HELD_AT (CONTACTS_AT + THIN_COLLIDERS * CONTACT_ROWS * STORED)
#define OF_NODE_AT (HELD_AT + STORED)

int contact_place(int body, int row, int index) {
    return (body * CONTACT_ROWS + row) * STORED + index;
}

int owner_of(int place) { return place % STORED; }

int row_of(int place) { return place / STORED % CONTACT_ROWS; }

ivec3 contact_offsets(int row) { return row == NODE_ROW ? ivec3(0) : surface_offsets(row); }

int nodes_in(int row) { return row == NODE_ROW ? 1 : surface_row_count(row); }

ivec3 nodes_of(int place) { return owner_of(place) + contact_offsets(row_of(place)); }

int contact_of_node(int at) { return int(surface_lists[OF_NODE_AT + at] >> 2); }

float weight_of_node(int at, SurfaceContact contact) {
    return contact.weights[surface_lists[OF_NODE_AT + at] & 3u];
}

// Resistance of a contact to a velocity u of its point.
vec3 resistance(SurfaceContact contact, vec3 u) {
    float along = dot(contact.normal.xyz, u);
    return (contact.impulse.w * contact.given.w - contact.begun.w) * along * contact.normal.xyz
        + contact.begun.w * u;
}

#ifdef KNOWS_COLLIDERS
// Impulse along the normal by the contact law, for the velocity u of its point relative to the collider.
float press_at(SurfaceContact contact, vec3 u) {
    return max(dot(contact.impulse.xyz, contact.normal.xyz) - contact.given.w
        * (dot(u, contact.normal.xyz) + max(contact.normal.w, 0.0) / substep), 0.0);
}

// Friction impulse if the contact stuck.
vec3 pull_at(SurfaceContact contact, vec3 u) {
    vec3 normal = contact.normal.xyz;
    return contact.impulse.xyz - dot(contact.impulse.xyz, normal) * normal
        - contact.sticking.x * (u - dot(u, normal) * normal);
}

// Max. friction impulse in a solve.
float most_friction(SurfaceContact contact) {
    return collider_friction[int(contact.weights.w)]
        * max(dot(contact.impulse.xyz, contact.normal.xyz), 0.0);
}
#endif
