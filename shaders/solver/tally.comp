// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Add the result of a solve to the statistics of the step.

layout(local_size_x = 1) in;

#define SCALARS_ACCESS readonly
#include "solver/scalars.glsl"

layout(std430, binding = SOLVER_TALLY) buffer Tally {
    float most_iterations;
    float worst_residual;  // squared, relative
    float unreached;
    float solves;
    float all_iterations;
};

uniform float tolerance_square;
uniform bool is_final;  // false if another solve continues this one

void main() {
    most_iterations = max(most_iterations, iterations);
    solves += 1.0;
    all_iterations += iterations;
    // Rounding alone makes it negative.
    float residual = abs(scale > 0.0 ? measure_after / scale : measure_after);
    // NaN fails the comparisons: it counts as not reached, and is stored in worst_residual.
    bool reached = scale >= 0.0 && residual <= tolerance_square;
    if (is_final) {
        unreached += reached ? 0.0 : 1.0;
        worst_residual = residual <= worst_residual ? worst_residual : residual;
    }
}
