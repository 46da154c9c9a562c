// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Partial sums for the rigid motion of the cloth. Each invocation sums STRIP nodes of a column:
// u, r, r x u and the products of r, for velocities or impulses u and positions r, by mass.

#include "lattice.glsl"
#include "state_in.glsl"
#include "applied_acceleration.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = PARTIAL_SUMS) writeonly buffer PartialSums { float partial_sums[]; };

uniform float substep;  // [s] of applied acceleration in u
uniform float share;    // of the velocity in u
uniform float back;     // [s] that the positions r are behind the present ones
uniform vec3 centre;    // [m] r is from here

void main() {
    int col = int(gl_GlobalInvocationID.x);
    int strip = int(gl_GlobalInvocationID.y);
    int first = strip * STRIP;
    if (first >= ROWS || col >= COLS) {
        return;
    }
    vec3 momentum = vec3(0.0);
    vec3 place = vec3(0.0);
    vec3 spin = vec3(0.0);
    vec3 squares = vec3(0.0);
    vec3 products = vec3(0.0);
    for (int row = first; row < min(first + STRIP, ROWS); ++row) {
        int index = node_index(row, col);
        vec3 v = load_velocity(index).xyz;
        vec3 u = share * v + substep * applied_acceleration(index);
        vec3 r = load_position(index).xyz - centre - back * v;
        float mass = mass_share(load_position(index));
        momentum += mass * u;
        place += mass * r;
        spin += mass * cross(r, u);
        squares += mass * (r * r);
        products += mass * (r.xxy * r.yzz);
    }
    int entry = 15 * (strip * COLS + col);
    for (int axis = 0; axis < 3; ++axis) {
        partial_sums[entry + axis] = momentum[axis];
        partial_sums[entry + 3 + axis] = place[axis];
        partial_sums[entry + 6 + axis] = spin[axis];
        partial_sums[entry + 9 + axis] = squares[axis];
        partial_sums[entry + 12 + axis] = products[axis];
    }
}
