// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The force of edges and bending on one node, loaded by itself: for the few nodes of which a pass
// over blocks keeps no force. Needs spring_law.glsl and the laws of bending.

#include "cells.glsl"

// By the edge from start to end, of which here is one.
vec3 pull_of(int here, int start, int end, int edge, int rest) {
    int there = here == start ? end : start;
    vec4 from = load_position(here);
    vec4 to = load_position(there);
    float share = here == start ? edge_share(from, to, edge) : edge_share(to, from, edge);
#if HAS_DAMPING
    vec3 dv = load_velocity(there).xyz - load_velocity(here).xyz;
#else
    vec3 dv = vec3(0.0);
#endif
    vec3 d = to.xyz - from.xyz;
    return spring_force(d, dv, share, rest);
}

#define ADD_PULLS(HERE, EDGE, DROW, DCOL, FAMILY, REST) \
    total += pull_of(HERE, HERE, HERE + DROW * PITCH + DCOL, EDGE, REST) \
        + pull_of(HERE, HERE - DROW * PITCH - DCOL, HERE, EDGE, REST);

#if HAS_RIGIDITY
vec3 bent_at(int index, int stride) {
    vec4 behind = load_position(index - stride);
    vec4 here = load_position(index);
    vec4 ahead = load_position(index + stride);
    return second_difference(
        line_share(behind, here, ahead, stride == 1 ? 0 : 1), behind.xyz, here.xyz, ahead.xyz);
}

vec3 unbent_at(int index, int stride) {
    return unbent(
        bent_at(index - stride, stride), bent_at(index, stride), bent_at(index + stride, stride));
}
#endif

vec3 node_force(int here) {
    vec3 total = vec3(0.0);
    EACH_EDGE(ADD_PULLS, here)
#if HAS_RIGIDITY
    total -= bending[0] * unbent_at(here, 1) + bending[1] * unbent_at(here, PITCH);
#endif
#if HAS_BENDING_DAMPING
    total -= bending_damping * (
        bending[0] * BENDING_BRAKE(here, 1) + bending[1] * BENDING_BRAKE(here, PITCH));
#endif
    return total;
}
