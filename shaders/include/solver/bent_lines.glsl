// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// What damping of bending resists, by the lines that solver/damp_bending.comp has kept.

#include "bending_damping.glsl"

// How fast the bend of a line grows, times the root of what damping weighs.
float bent_speed(vec4 line, vec3 behind, vec3 here, vec3 ahead) {
    return bending_speed(BentLine(line.xyz, line.w), behind, here, ahead);
}

vec4 kept_brake(vec4 line, vec3 behind, vec3 here, vec3 ahead) {
    return vec4(bent_speed(line, behind, here, ahead) * line.xyz, line.w);
}

// What the nodes of the block resist of a vector in the tile OF, added to TOTAL.
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
