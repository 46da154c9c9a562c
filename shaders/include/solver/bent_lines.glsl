// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Damping of bending in the matrix, by the lines that solver/damp_bending.comp has stored.

#include "bending_damping.glsl"

// Rate of the bend of a line, times the root of the damping coefficient.
float bent_speed(vec4 line, vec3 behind, vec3 here, vec3 ahead) {
    return bending_speed(BentLine(line.xyz, line.w), behind, here, ahead);
}

vec4 kept_brake(vec4 line, vec3 behind, vec3 here, vec3 ahead) {
    return vec4(bent_speed(line, behind, here, ahead) * line.xyz, line.w);
}

// Add the damping matrix of the block times the vector in the tile OF to TOTAL.
#define ADD_BENT_LINES(TOTAL, OF, FIRST) { \
    vec4 brake[TILE][TILE]; \
    ADD_BENT_LINES_ALONG(TOTAL, OF, FIRST, 0, 1) \
    ADD_BENT_LINES_ALONG(TOTAL, OF, FIRST, 1, 0) \
}

#define ADD_BENT_LINES_ALONG(TOTAL, OF, FIRST, DROW, DCOL) \
    FOR_BENT(DROW, DCOL) { \
        brake[row][col] = kept_brake( \
            load_system(cloth_entry(BENT_LINES + DROW, tile_index(FIRST, row, col))), \
            OF[row - DROW][col - DCOL], OF[row][col], OF[row + DROW][col + DCOL]); \
    } \
    FOR_BENT(0, 0) { \
        TOTAL[row][col] += braked( \
            brake[row - DROW][col - DCOL], brake[row][col], brake[row + DROW][col + DCOL]); \
    }
