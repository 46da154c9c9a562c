// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Nearly solve the coarsest level: Chebyshev iteration in one workgroup, a node an invocation.
// Levels smaller than COARSEST_SIDE leave invocations idle; all of the workgroup pass every barrier.
// Includer: COARSEST_GROUP, the invocations of the workgroup.

// Middle and half width of the eigenvalues it damps.
uniform float middle;
uniform float half_width;

// With a border, whose values weigh nothing, but must be finite.
shared vec3 values[COARSEST_SIDE + 2][COARSEST_SIDE + 2];

// The solution at a node of the level for its residual.
vec3 nearly_solve(ivec2 at, bool is_node, vec3 residual) {
    int index = is_node ? level_index(level, at.x, at.y) : 0;
    for (int i = int(gl_LocalInvocationIndex); i < (COARSEST_SIDE + 2) * (COARSEST_SIDE + 2);
            i += COARSEST_GROUP) {
        values[i / (COARSEST_SIDE + 2)][i % (COARSEST_SIDE + 2)] = vec3(0.0);
    }
    Symmetric ahead[DIRECTIONS];
    Symmetric behind[DIRECTIONS];
    Symmetric diagonal = load_symmetric(level, GROUND, index);
    for (int i = 0; i < DIRECTIONS; ++i) {
        ahead[i] = load_edge(level, index, i);
        behind[i] = load_edge(level, is_node
            ? level_index(level, at.x - TOWARDS[i].x, at.y - TOWARDS[i].y) : 0, i);
        diagonal += ahead[i] + behind[i];
    }
    Symmetric inverse_block = load_symmetric(level, INVERSE, index);
    vec3 change = times(inverse_block, residual) / middle;
    vec3 value = change;
    float ratio = half_width / middle;
    barrier();
    for (int step = 1; step < COARSEST_STEPS; ++step) {
        if (is_node) {
            values[at.x + 1][at.y + 1] = value;
        }
        barrier();
        vec3 left = residual - times(diagonal, value);
        for (int i = 0; i < DIRECTIONS; ++i) {
            ivec2 to = at + 1 + TOWARDS[i];
            ivec2 from = at + 1 - TOWARDS[i];
            left += times(ahead[i], values[to.x][to.y]) + times(behind[i], values[from.x][from.y]);
        }
        barrier();
        float next = 1.0 / (2.0 * middle / half_width - ratio);
        change = next * ratio * change + (2.0 * next / half_width) * times(inverse_block, left);
        value += change;
        ratio = next;
    }
    return value;
}
