// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Correction of a tile by the level below: bilinear between its nodes, which lie at the centres of
// four nodes here, and constant beyond the outermost.

#define COARSE_TILE (BLOCK / 2 + 2 * REACH)

vec3 correction[TILE][TILE];

void load_correction(int below, ivec2 first) {
    vec3 coarse[COARSE_TILE][COARSE_TILE];
    vec3 across[COARSE_TILE][TILE];
    ivec2 last = level_shape[below].yx - 1;
    for (int row = 0; row < COARSE_TILE; ++row) {
        for (int col = 0; col < COARSE_TILE; ++col) {
            ivec2 at = clamp(first / 2 + ivec2(col, row) - REACH, ivec2(0), last);
            coarse[row][col] = load_vector(
                vector_entry(below, PRECONDITIONED, level_index(below, at.y, at.x)));
        }
    }
    for (int row = 0; row < COARSE_TILE; ++row) {
        for (int col = 0; col < TILE; ++col) {
            int near = (col + REACH) / 2;
            int far = near + 2 * ((col + REACH) % 2) - 1;
            across[row][col] = 0.75 * coarse[row][near] + 0.25 * coarse[row][far];
        }
    }
    for (int row = 0; row < TILE; ++row) {
        for (int col = 0; col < TILE; ++col) {
            int near = (row + REACH) / 2;
            int far = near + 2 * ((row + REACH) % 2) - 1;
            correction[row][col] = 0.75 * across[near][col] + 0.25 * across[far][col];
        }
    }
}
