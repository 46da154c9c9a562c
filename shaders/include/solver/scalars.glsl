// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// What conjugate gradients carry from one iteration to the next.

layout(std430, binding = SOLVER_SCALARS) SCALARS_ACCESS buffer Scalars {
    float step_length;  // along the direction; 0 when there is nothing to add
    float keep;         // of the last direction in the next
    float measure;      // residual times preconditioned residual
    float measure_start;
    float measure_after;  // expected after the last iteration
    float iterations;   // made so far
    float is_going;     // 1 where there is another iteration
    uint finished_groups;  // workgroups of product.comp that have ended, while it runs
    uint is_off;        // the bits of 1.0 where lengths are off by more than rounding, before a further solve
    float scale;        // square of the change of velocity that the residual is small beside
};
