// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Changes of lengths by a round [m] that suffice: as while the cloth rests, as while it moves, and
// from which first change on it counts as moving.
uniform float tolerance;
uniform float loose_tolerance;
uniform float motion;
uniform vec2 reduction;  // shares of the first change of a substep, at rest and in motion

float sufficient(float first) {
    float share = first > motion ? reduction.y : reduction.x;
    return max(tolerance, min(loose_tolerance, share * first));
}
