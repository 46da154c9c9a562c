// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Positions [m] and velocities [m/s] that can be reckoned with: beyond MOST_MAGNITUDE their squares
// and sums leave float32. Compares bits, since a compiler may assume that no float is NaN.

bool is_bounded(vec3 v) {
    return all(lessThan(
        floatBitsToUint(v) & uvec3(0x7fffffffu), uvec3(floatBitsToUint(MOST_MAGNITUDE))));
}
