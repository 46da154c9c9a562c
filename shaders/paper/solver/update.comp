// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The new tensions and their residual.

#include "paper/solver/buffers.glsl"

layout(local_size_x = 1024) in;

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i < CONSTRAINTS) {
        ENTRY(LAMBDA, i) += scalars[STEP_LENGTH] * ENTRY(DIRECTION, i);
        ENTRY(RESIDUAL, i) -= scalars[STEP_LENGTH] * ENTRY(IMAGE, i);
    }
}
