// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Damping of bending: a line of three nodes resists the growth of its bend, which is the part of
// its second difference D across the line. What stretches or turns it is not resisted, so that a
// bent cloth rotates as freely as without damping. With e = D . t along the unit vector t from the
// node behind to that ahead, l apart, the bend |D - e t| grows by the velocities of the nodes, times
// 1 + e / l, -2 and 1 - e / l, along its direction.
// Nodes are loaded one by one: kept in the tile of a block, they made compilers fail.

#include "bending.glsl"

struct BentLine {
    vec3 across;  // unit vector of the bend; 0 where the line is straight, or leaves the cloth
    float skew;   // e / l
};

// Of the line around a node; stride is 1 along a row, the pitch of rows along a column.
BentLine bent_line(int index, int stride) {
    vec4 behind = load_position(index - stride);
    vec4 here = load_position(index);
    vec4 ahead = load_position(index + stride);
    vec3 bent = second_difference(
        behind.w * here.w * ahead.w, behind.xyz, here.xyz, ahead.xyz);
    vec3 chord = ahead.xyz - behind.xyz;
    float skew = dot(bent, chord) / max(dot(chord, chord), 1e-20);
    bent -= skew * chord;
    return BentLine(bent * inversesqrt(max(dot(bent, bent), 1e-30)), skew);
}

// How fast the bend of a line grows [m/s].
float bending_speed(BentLine line, vec3 behind, vec3 here, vec3 ahead) {
    return dot(line.across, ((behind - here) + (ahead - here)) - line.skew * (ahead - behind));
}

// What the line around a node resists there, and at the nodes behind and ahead, over c and the
// damping time.
vec3 line_brake(int index, int stride, int place) {
    BentLine line = bent_line(index, stride);
    float speed = bending_speed(
        line, load_velocity(index - stride).xyz, load_velocity(index).xyz,
        load_velocity(index + stride).xyz);
    float part = place == 0 ? -2.0 : 1.0 - float(place) * line.skew;
    return part * speed * line.across;
}

// What a node resists along a row or a column, over c and the damping time. Both neighbours first:
// a mirrored cloth rounds alike.
vec3 bending_brake(int index, int stride) {
    return (line_brake(index - stride, stride, 1) + line_brake(index + stride, stride, -1))
        + line_brake(index, stride, 0);
}
