// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The state as the solver sees it: stored with rows state_pitch apart. Beyond what is stored lie
// ghosts like the outermost.

uniform int state_pitch;

int state_index(int row, int col) {
    return (min(row, ROWS) + HALO) * state_pitch + min(col, COLS) + HALO;
}
