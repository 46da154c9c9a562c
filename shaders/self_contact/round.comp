// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// A round: each contact that acts changes its impulse by what the velocities of its nodes lack. With
// s_k the sum of the weights of the node k, sum_k |w_k| s_k / m_k is no less than what an impulse
// changes, whatever other contacts do, so that rounds converge for any stack (Cauchy-Schwarz).

#include "lattice.glsl"
#include "self_contact/head.glsl"
#include "self_contact/contacts.glsl"
#include "self_contact/found_contact.glsl"

layout(local_size_x = SELF_LOCAL) in;

layout(std430, binding = SELF_KEPT) buffer SelfKept { vec4 kept[]; };
layout(std430, binding = SELF_ACTING) buffer SelfActing { vec4 acting[]; };
// Velocity of a node [m/s], and its inverse mass times its weights in contacts that act.
layout(binding = SELF_VELOCITIES) uniform samplerBuffer velocities;

uniform float substep;   // [s]
uniform float friction;  // [1]
uniform int part;        // FIRST and LAST of the rounds of a substep, as bits

#define FIRST 1
#define LAST 2
// Part of what layers are too near by that is made good in a substep, and the fastest way [m/s].
#define WAY_PART 0.2
#define MOST_WAY_SPEED 1.0

void move_out(int node, float weight, vec3 way) {
    float unit = MOST_WAY_SPEED * substep * (IMPULSE_RANGE / 2147483648.0);
    ivec3 change = ivec3(round(weight * way / unit));
    for (int k = 0; k < 3; ++k) {
        if (change[k] != 0) {
            atomicAdd(self_nodes[node].way[k], change[k]);
        }
    }
}

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= acting_count) {
        return;
    }
    vec4 own = load_acting(number);
    SelfContact found = load_contact(floatBitsToInt(own.w));
    vec4 weights = all_weights(found.weights);
    // Velocity of the first side against the second, and what an impulse of 1 changes of it at most.
    vec3 u = vec3(0.0);
    float share = 0.0;
    for (int k = 0; k < 4; ++k) {
        vec4 v = texelFetch(velocities, found.nodes[k]);
        u += weights[k] * v.xyz;
        share += abs(weights[k]) * v.w;
    }
    vec3 normal = found.normal.xyz;
    float gap = found.normal.w;
    float pressed = dot(own.xyz, normal);
    float along_normal = dot(u, normal);
    if (share <= 0.0) {
        return;
    }
    float now = clamp(
        pressed - (along_normal + max(gap, 0.0) / substep) / share, 0.0, most_impulse());
    vec3 along = own.xyz - pressed * normal - (u - along_normal * normal) / share;
    float most = friction * now;
    float l = length(along);
    along *= l > most ? most / max(l, 1e-30) : 1.0;
    vec3 impulse = now * normal + along;
    vec3 way = normal * (min(-WAY_PART * gap, MOST_WAY_SPEED * substep) / share);
    int moved = (part & FIRST) != 0 && gap < 0.0 ? 4 : 0;
    for (int k = 0; k < moved; ++k) {
        move_out(found.nodes[k], weights[k], way);
    }
    acting[number].xyz = impulse;
    if ((part & LAST) != 0) {
        kept[floatBitsToUint(found.impulse.w)] = vec4(impulse, 0.0);
        atomicMax(largest_impulse, floatBitsToUint(length(impulse)));
        atomicMax(largest_change, floatBitsToUint(share * length(impulse - own.xyz)));
    }
}
