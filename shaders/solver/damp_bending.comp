// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Damping of bending in a solve: store the coefficients of the lines of three nodes, and subtract
// their force at the velocities before from the right side. The matrix adds the change of velocity.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "state_in.glsl"
#include "solver/state_index.glsl"
#include "bending_damping.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float damping_weight[2];  // along a row and along a column, over the node mass

void main() {
    int row = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    int index = state_index(row, col);
    int entry = level_index(0, row, col);
    vec3 resisted = vec3(0.0);
    for (int direction = 0; direction < 2; ++direction) {
        int stride = direction == 0 ? 1 : state_pitch;
        vec4 behind = load_position(index - stride);
        vec4 here = load_position(index);
        vec4 ahead = load_position(index + stride);
        BentLine line = bent_line(behind, here, ahead);
        float root = sqrt(line_share(behind, here, ahead, direction));
        system_data[cloth_entry(BENT_LINES + direction, entry)] =
            vec4(root * sqrt(damping_weight[direction]) * line.across, line.skew);
        resisted += damping_weight[direction] * BENDING_BRAKE(index, stride);
    }
    if (load_velocity(index).w > 0.0) {
        vec3 residual = load_vector(cloth_entry(RESIDUAL, entry));
        store_vector(cloth_entry(RESIDUAL, entry), residual - resisted);
    }
}
