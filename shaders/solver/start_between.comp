// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Go share of the way from where a solve began to its solution: there the next one starts, or,
// after the last one, the solution is taken to be.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/points.glsl"

layout(local_size_x = POINT_LOCAL) in;

uniform int start_field;
uniform float guess;
uniform float share;
uniform int into;  // START or SOLUTION

void main() {
    FOR_POINTS {
        vec3 start = guess * load_vector(cloth_entry(start_field, index));
        vec3 solution = load_vector(cloth_entry(SOLUTION, index));
        store_vector(cloth_entry(into, index), mix(start, solution, share));
    }
}
