// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// One iteration's new direction, solution and residual, and the first smoothing of the latter.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/points.glsl"
#include "solver/smooth_residual.glsl"

#define SCALARS_ACCESS readonly
#include "solver/scalars.glsl"

layout(local_size_x = POINT_LOCAL) in;

vec3 load(int field, int index) { return load_vector(cloth_entry(field, index)); }

void store(int field, int index, vec3 v) { store_vector(cloth_entry(field, index), v); }

void main() {
    // Before the first iteration these fields have values of the last solve.
    bool goes_on = iterations > 1.0;
    float kept = keep;
    float length = step_length;
    FOR_POINTS {
        vec3 direction = load(PRECONDITIONED, index);
        vec3 image = load(PRODUCT, index);
        vec3 solution = load(SOLUTION, index);
        vec3 residual = load(RESIDUAL, index);
        if (goes_on) {
            direction += kept * load(DIRECTION, index);
            image += kept * load(IMAGE, index);
        }
        // A NaN is applied, too, so that it is detected.
        if (!(length == 0.0)) {
            solution += length * direction;
            residual -= length * image;
        }
        store(DIRECTION, index, direction);
        store(IMAGE, index, image);
        store(SOLUTION, index, solution);
        store(RESIDUAL, index, residual);
        smooth_residual(index, residual);
    }
}
