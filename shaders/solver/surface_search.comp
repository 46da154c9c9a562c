// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// What contacts with thin colliders add to limit_search.comp: a solve takes those that act for
// springs that pull as well, and has none of the others. One workgroup.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/state_index.glsl"
#include "state_in.glsl"
#include "contact.glsl"

layout(local_size_x = SURFACE_LOCAL) in;

layout(std430, binding = SOLVER_SUMS) writeonly buffer PartialSums { vec4 partial_sums[]; };

uniform float substep;    // [s]
uniform int start_field;  // where the solve began, of which
uniform float guess;      // this share
uniform float share;      // of the way to its solution
uniform int sum_at;

#define KNOWS_COLLIDERS
#include "solver/surface_contacts.glsl"

vec3 look(int place) {
    SurfaceContact contact = surface_contacts[place];
    ivec3 nodes = nodes_of(place);
    vec3 u = vec3(0.0), x = vec3(0.0), from = vec3(0.0), way = vec3(0.0);
    for (int i = 0; i < nodes_in(row_of(place)); ++i) {
        int index = nodes[i];
        bool moves = load_system(cloth_entry(NODE, index)).w > 0.0;
        vec3 start = moves ? guess * load_vector(cloth_entry(start_field, index)) : vec3(0.0);
        vec3 to = moves ? load_vector(cloth_entry(SOLUTION, index)) - start : vec3(0.0);
        int at = state_index(index / PITCH - HALO, index % PITCH - HALO);
        u += contact.weights[i] * load_velocity(at).xyz;
        x += contact.weights[i] * load_vector(cloth_entry(BEGIN_POSITION, index));
        from += contact.weights[i] * start;
        way += contact.weights[i] * to;
    }
    vec3 change = from + share * way;
    u += change - surface_velocity(int(contact.weights.w), x);
    vec3 normal = contact.normal.xyz;
    float missing = press_at(contact, u)
        - dot(contact.begun.xyz - resistance(contact, change), normal);
    return vec3(
        dot(way, resistance(contact, way)), -missing * dot(way, normal),
        missing * missing / (1.0 + contact.given.w));
}

shared vec3 sums[SURFACE_LOCAL];

void main() {
    uint lane = gl_LocalInvocationID.x;
    vec3 sum = vec3(0.0);
    for (uint i = lane; i < listed_contacts; i += SURFACE_LOCAL) {
        sum += look(int(surface_lists[uint(CONTACTS_AT) + i]));
    }
    sums[lane] = sum;
    barrier();
    if (lane == 0u) {
        for (int i = 1; i < SURFACE_LOCAL; ++i) {
            sum += sums[i];
        }
        partial_sums[sum_at] = vec4(sum, 0.0);
    }
}
