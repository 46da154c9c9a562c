// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// How hard an edge pulls, over the node mass: see sim/solver/edge_law.py.

// Structural, shear, bend:
uniform float shortest[3];         // [rest lengths] below which the lower limit pulls
uniform float longest[3];          // [rest lengths] above which the upper one does
// Along a row, along a column, diagonal, two along each:
uniform float edge_stiffness[5];   // [1/s2]
uniform float edge_damping[5];     // [1/s]
uniform float limit_stiffness[5];  // [1/s2]
uniform float rest_length[5];      // [m]

// The energy of an edge of length l, without damping [m2/s2].
float stored_energy(float l, int family, int rest) {
    float rest_l = rest_length[rest];
    float stretch = l - rest_l;
    float beyond = l - clamp(l, shortest[family] * rest_l, longest[family] * rest_l);
    return 0.5 * (edge_stiffness[rest] * stretch * stretch
        + limit_stiffness[rest] * beyond * beyond);
}

// The pull of an edge [m/s2], and how much more it is for each metre more of length [1/s2].
struct Pull {
    float tension;
    float slope;
};

// Of an edge of length l, with the limit in force that it has at the length judged: the law is
// taken on from there as a straight line.
Pull pull_at(float l, float judged, float rate, int family, int rest) {
    float rest_l = rest_length[rest];
    float bound = clamp(judged, shortest[family] * rest_l, longest[family] * rest_l);
    bool in_force = bound != judged || shortest[family] == longest[family];
    float limit = in_force ? limit_stiffness[rest] : 0.0;
    return Pull(
        edge_stiffness[rest] * (l - rest_l) + edge_damping[rest] * rate
            + limit * (l - bound),
        edge_stiffness[rest] + limit);
}
