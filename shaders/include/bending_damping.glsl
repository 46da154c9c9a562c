// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Damping of bending: a line of three nodes resists the growth of its bend, which is the part of
// its second difference D across the line. What stretches or turns it is not resisted, so that a
// bent cloth rotates as freely as without damping. With e = D . t along the unit vector t from the
// node behind to that ahead, l apart, the bend |D - e t| grows by the velocities of the nodes, times
// 1 + e / l, -2 and 1 - e / l, along its direction. Where a line of uneven lengths is folded up,
// e / l is large: there the growth counts for less, so that no line resists more than an even one.

#include "bending.glsl"
#include "cells.glsl"

struct BentLine {
    vec3 across;  // along the bend, 1 long or less; 0 where the line is straight
    float skew;   // e / l
};

BentLine bent_line(vec4 behind, vec4 here, vec4 ahead) {
    vec3 bent = second_difference(1.0, behind.xyz, here.xyz, ahead.xyz);
    vec3 chord = ahead.xyz - behind.xyz;
    float skew = dot(bent, chord) / max(dot(chord, chord), 1e-20);
    bent -= skew * chord;
    // The squares of what the nodes count add up to 6 and twice that of the skew.
    float scale = max(dot(bent, bent), 1e-30) * (1.0 + skew * skew / 3.0);
    return BentLine(bent * inversesqrt(scale), skew);
}

// How fast the bend of a line grows [m/s].
float bending_speed(BentLine line, vec3 behind, vec3 here, vec3 ahead) {
    return dot(line.across, ((behind - here) + (ahead - here)) - line.skew * (ahead - behind));
}

// Damping force of a line along its bend, over c and the damping time, from its positions and
// velocities (xyz); its skew (w).
vec4 line_brake(
        vec4 behind, vec4 here, vec4 ahead, vec3 behind_speed, vec3 here_speed, vec3 ahead_speed,
        int direction) {
    BentLine line = bent_line(behind, here, ahead);
    float share = line_share(behind, here, ahead, direction);
    float speed = bending_speed(line, behind_speed, here_speed, ahead_speed);
    return vec4((share * speed) * line.across, line.skew);
}

// Damping force on a node by the lines centred at the nodes behind, here and ahead. Both neighbours
// are added first, so that a mirrored cloth rounds alike.
vec3 braked(vec4 behind, vec4 here, vec4 ahead) {
    return ((1.0 - behind.w) * behind.xyz + (1.0 + ahead.w) * ahead.xyz) - 2.0 * here.xyz;
}

#define LINE_BRAKE(INDEX, STRIDE) line_brake( \
    load_position(INDEX - STRIDE), load_position(INDEX), load_position(INDEX + STRIDE), \
    load_velocity(INDEX - STRIDE).xyz, load_velocity(INDEX).xyz, \
    load_velocity(INDEX + STRIDE).xyz, STRIDE == 1 ? 0 : 1)

// Damping force on a node along a row (stride 1) or a column (the pitch of rows), from single loads.
#define BENDING_BRAKE(INDEX, STRIDE) braked( \
    LINE_BRAKE(INDEX - STRIDE, STRIDE), LINE_BRAKE(INDEX, STRIDE), \
    LINE_BRAKE(INDEX + STRIDE, STRIDE))
