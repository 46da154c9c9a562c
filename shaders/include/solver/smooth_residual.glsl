// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The first smoothing of the cloth, or the whole preconditioner when that is block-Jacobi.

#include "solver/smoothing_steps.glsl"

void smooth_residual(int index, vec3 residual) {
    store_vector(
        cloth_entry(SMOOTHED_INTO, index), first_step * times(load_cloth_inverse(index), residual));
}
