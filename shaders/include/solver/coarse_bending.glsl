// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Coarse levels have edges alone, and bending is no edge. There, edges along rows and columns stand
// for it that resist waves of four nodes of a level as bending does: these are what the level is
// for. Longer waves, which they resist too much, are left to the levels below.

uniform float bending_bound[2];  // as in solver/assemble.comp

// A level has twice the spacing of the one above, and four times the mass in a node.
Symmetric bending_edge(int which, int direction) {
    return scaled_identity(
        direction < 2 ? 2.0 * exp2(-2.0 * float(which)) * bending_bound[direction] : 0.0);
}
