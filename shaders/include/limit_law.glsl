// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// What an edge may be at the end of a substep, and the impulse that makes it so
// (docs/explanation/adaptive.md). The end of an edge at its upper limit stays in a ball around its
// start; at its lower limit it stays beyond a plane.

#include "cells.glsl"

// Strain beyond the limit over that [1] that counts as far.
#define MISSED 0.05

// How far an edge passes its limit for each impulse over the mass of a node [s], along a row,
// along a column and diagonal.
uniform float compliance[3];
float compliances[3] = float[](compliance[0], compliance[1], compliance[2]);

float compliance_of(int code) {
    int edge = code & 3;
    return edge == EDGE_ROW ? compliances[0]
        : edge == EDGE_COLUMN ? compliances[1] : compliances[2];
}

uniform float closing;  // share of an excess that a substep takes away
float closed = READ_FIRST(closing);

struct Edge {
    vec3 d;        // [m] from start to end, as the substep begins
    float l;       // [m] its length
    float target;  // [m] the largest, or the smallest, length at the end
    float over;    // [m] length less the target
    float give;    // [s] how far it passes the target for each impulse over the mass of a node
};

Edge edge_between(vec4 start, vec4 end, int code) {
    vec3 d = end.xyz - start.xyz;
    float l = length_and_inverse(d).x;
    float bound = rest_of(code) * (1.0 + (code < SHORTEST ? strain_limit : -strain_limit));
    // The difference of squares keeps the digits.
    float over = (dot(d, d) - bound * bound) / (l + bound);
    bool is_beyond = code < SHORTEST ? over > 0.0 : over < 0.0;
    over = is_beyond ? closed * over : over;
    // A limit has the share of a whole line's stiffness that its spring has.
    float give = compliance_of(code) / edge_share(start, end, code & 3);
    return Edge(d, l, l - over, over, give);
}

// Whether an edge is far beyond its limit, and no impulse has held it in the previous substep.
bool is_missed(Edge edge, int code, vec3 given) {
    float beyond = (code < SHORTEST ? edge.over : -edge.over) / closed;
    return beyond > MISSED * strain_limit * rest_of(code) && given == vec3(0.0);
}

// Displacement [m] that puts the end within the limit, where it would come by e [m] without.
vec3 pull_back(Edge edge, int code, vec3 e) {
    if (code < SHORTEST) {
        vec3 q = edge.d + e;
        vec2 l = length_and_inverse(q);
        float past = (edge.over * (edge.l + edge.target) + dot(e, 2.0 * edge.d + e))
            / (l.x + edge.target);
        return max(past, 0.0) * l.y * q;
    }
    vec3 n = edge.d / max(edge.l, 1e-20);
    return min(edge.over + dot(n, e), 0.0) * n;
}

// Impulse over the mass of a node [m/s] that pulls the end towards the start, where it would come
// by e [m] without; per_impulse: what each moves it by [s].
vec3 impulse_for(Edge edge, int code, vec3 e, float per_impulse) {
    // 0 between two pins.
    vec3 pull = pull_back(edge, code, e) / max(per_impulse + edge.give, 1e-30);
    return per_impulse > 0.0 ? pull : vec3(0.0);
}

// What an impulse that was given before [m/s] takes from the energy of the nodes for each part of
// it that is given, over the mass of a node [m2/s2]. It falls with that part: where it is 0, the
// energy is lowest. dv: velocity of the end less that of the start, with the part.
float gain_of(Edge edge, int code, vec3 given, vec3 dv, float substep, float part) {
    float size = length(given);
    vec3 off = given / max(size, 1e-30) - edge.d / max(edge.l, 1e-20);
    float past = code < SHORTEST ? edge.over - 0.5 * edge.l * dot(off, off) : -edge.over;
    past -= part * edge.give * size;
    return dot(given, dv) + size * past / substep;
}
