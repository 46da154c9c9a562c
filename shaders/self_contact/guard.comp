// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Let no pair pass through each other: one pair an invocation. Where the ways of both are apart along
// an axis, nothing happens. Otherwise a plane at rest divides their gap, and each node keeps the part of
// its own way that stays on its side: so nothing passes, whatever is left of the ways of other nodes.

#define POSITIONS_ALONE 1
#include "lattice.glsl"
#include "state_in.glsl"
#include "self_contact/features.glsl"
#include "self_contact/nearest.glsl"
#include "self_contact/head.glsl"
#include "self_contact/pairs.glsl"
#include "self_contact/contacts.glsl"

layout(local_size_x = SELF_LOCAL) in;

layout(binding = POSITION_OUT) uniform samplerBuffer position_out;

// Part of a gap that is left in a substep [1].
#define LEFT 0.2
// Rounding of a position over its coordinates [1].
#define ROUNDING 4e-7

uniform float thickness;  // [m]
uniform float rounding;   // [m] of ways
uniform vec3 common_way;  // [m] of all nodes

vec3 from[4], way[4];

#if OF_EDGES
#define SPLIT 2

vec3 nearest_of(vec3 at[4]) {
    vec3 d = at[1] - at[0], e = at[3] - at[2];
    vec3 near = nearest_on_segments(at[0], d, at[2], e);
    return at[0] + near.x * d - at[2] - near.y * e;
}

vec3 across(vec3 at[4]) { return cross(at[1] - at[0], at[3] - at[2]); }
#else
#define SPLIT 1

vec3 nearest_of(vec3 at[4]) {
    int place;
    vec3 a = at[1] - at[0], b = at[2] - at[0], c = at[3] - at[0];
    vec3 weights = nearest_in_triangle(a, b, c, place);
    return -(weights.x * a + weights.y * b + weights.z * c);
}

vec3 across(vec3 at[4]) { return cross(at[2] - at[1], at[3] - at[1]); }
#endif

// Along an axis: least of the first feature and most of the second, at the begin and on the way.
vec4 spans(vec3 axis) {
    vec4 found = vec4(1e30, -1e30, 1e30, -1e30);
    for (int k = 0; k < 4; ++k) {
        float begin = dot(axis, from[k]);
        float end = begin + dot(axis, way[k]);
        if (k < SPLIT) {
            found.xz = min(found.xz, vec2(begin, end));
        } else {
            found.yw = max(found.yw, vec2(begin, end));
        }
    }
    return found;
}

void guard(uint own, uint other, float least) {
    ivec4 nodes = pair_nodes(own, other);
    vec3 origin = load_position(nodes.x).xyz;
    float coordinate = 0.0;
    vec2 longest = vec2(0.0);
    for (int k = 0; k < 4; ++k) {
        vec3 x = load_position(nodes[k]).xyz;
        from[k] = x - origin;
        way[k] = texelFetch(position_out, nodes[k]).xyz - x - common_way;
        coordinate = max(coordinate, max(abs(x.x), max(abs(x.y), abs(x.z))));
        float l = length(way[k]);
        longest = max(longest, k < SPLIT ? vec2(l, 0.0) : vec2(0.0, l));
    }
    float margin = ROUNDING * coordinate + 1e-9;
    if ((1.0 - LEFT) * least > longest.x + longest.y + 2.0 * margin) {
        return;
    }
    vec3 to[4];
    for (int k = 0; k < 4; ++k) {
        to[k] = from[k] + way[k];
    }
    vec3 best = vec3(0.0);
    float widest = 0.0;
    for (int which = 0; which < 4; ++which) {
        vec3 axis = which == 0 ? nearest_of(from) : which == 1 ? across(from)
            : which == 2 ? nearest_of(to) : across(to);
        float l = length(axis);
        if (!(l > 1e-20)) {
            continue;
        }
        axis /= l;
        vec4 ends = spans(axis);
        if (which % 2 == 1 && ends.x - ends.y < 0.0) {
            // The side of the first feature is known for the nearest points only.
            axis = -axis;
            ends = spans(axis);
        }
        float gap = ends.x - ends.y;
        float on_way = min(ends.x, ends.z) - max(ends.y, ends.w);
        if (gap > 0.0 && on_way >= min(LEFT * gap, 0.1 * thickness)) {
            return;
        }
        if (gap > widest) {
            widest = gap;
            best = axis;
        }
    }
    if (widest <= 0.0) {
        atomicAdd(undivided, 1u);
        return;
    }
    vec4 ends = spans(best);
    float of_first = max(0.0, ends.x - ends.z), of_second = max(0.0, ends.w - ends.y);
    float room = max(widest * (1.0 - LEFT) - margin, 0.0);
    float share = of_first + of_second > 0.0 ? of_first / (of_first + of_second) : 0.5;
    float above = ends.x - room * share, below = ends.y + room * (1.0 - share);
    for (int k = 0; k < 4; ++k) {
        float begin = dot(best, from[k]), step = dot(best, way[k]);
        float past = k < SPLIT ? above - begin : begin - below;
        float towards = k < SPLIT ? -step : step;
        if (towards > 0.0 && towards > -past) {
            atomicMin(self_nodes[nodes[k]].cut, floatBitsToUint(max(-past, 0.0) / towards));
        }
    }
}

void main() {
    bool is_there = has_pair(0);
    uint i = is_there ? pair_place(0) : 0u;
    Pair pair = load_pair(i);
    // Cells have gone that far already, with the present substep.
    vec2 ways = ways_of(pair);
    float least = pair.distance - ways.x + ways.y;
    if (is_there && (1.0 - LEFT) * least <= ways.y + rounding) {
        guard(pair.own, pair.other, least);
    }
}
