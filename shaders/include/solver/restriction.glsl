// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// How a coarse node takes from finer ones, by the transpose of what solver/correction.glsl does.

// Weights of the four finer nodes around a coarse one along a side of the level.
vec4 shares(int at, int count) {
    return vec4(
        at > 0 ? 0.25 : 0.0, at > 0 ? 0.75 : 1.0,
        at + 1 < count ? 0.75 : 1.0, at + 1 < count ? 0.25 : 0.0);
}
