// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// What damping of bending resists, by the lines that solver/damp_bending.comp has kept.

// How fast the bend of a line grows, times the root of what damping weighs.
float bent_speed(vec4 line, vec3 behind, vec3 here, vec3 ahead) {
    return dot(line.xyz, ((behind - here) + (ahead - here)) - line.w * (ahead - behind));
}

// What a line resists at the node around which it is, besides that times its skew: towards that
// ahead and the one behind, in w and xyz.
vec4 line_pull(vec4 line, vec3 behind, vec3 here, vec3 ahead) {
    return vec4(bent_speed(line, behind, here, ahead) * line.xyz, line.w);
}

vec3 pulled(vec4 behind, vec4 here, vec4 ahead) {
    return ((1.0 - behind.w) * behind.xyz + (1.0 + ahead.w) * ahead.xyz) - 2.0 * here.xyz;
}

// What the nodes of the block resist of a vector in the tile OF, added to TOTAL.
#define ADD_BENT_LINES(TOTAL, OF, FIRST) { \
    vec4 pull[TILE][TILE]; \
    FOR_BENT(0, 1) { \
        pull[row][col] = line_pull( \
            load_system(cloth_entry(BENT_LINES, tile_index(FIRST, row, col))), \
            OF[row][col - 1], OF[row][col], OF[row][col + 1]); \
    } \
    FOR_BENT(0, 0) { \
        TOTAL[row][col] += pulled(pull[row][col - 1], pull[row][col], pull[row][col + 1]); \
    } \
    FOR_BENT(1, 0) { \
        pull[row][col] = line_pull( \
            load_system(cloth_entry(BENT_LINES + 1, tile_index(FIRST, row, col))), \
            OF[row - 1][col], OF[row][col], OF[row + 1][col]); \
    } \
    FOR_BENT(0, 0) { \
        TOTAL[row][col] += pulled(pull[row - 1][col], pull[row][col], pull[row + 1][col]); \
    } \
}
