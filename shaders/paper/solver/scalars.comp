// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The scalars of conjugate gradients, from a scalar product.

#include "paper/solver/buffers.glsl"

layout(local_size_x = 1) in;

#define AT_START 0
#define AFTER_PRODUCT 1
#define AFTER_UPDATE 2

uniform int group_count;
uniform int stage;

void main() {
    float sum = 0.0;
    for (int group = 0; group < group_count; ++group) {
        sum += scalars[GROUP_SUMS + group];
    }
    if (stage == AFTER_PRODUCT) {
        scalars[STEP_LENGTH] = scalars[SQUARE] / sum;
        return;
    }
    if (stage == AT_START) {
        scalars[SQUARE_START] = sum;
    } else {
        scalars[KEEP] = sum / scalars[SQUARE];
    }
    scalars[SQUARE] = sum;
}
