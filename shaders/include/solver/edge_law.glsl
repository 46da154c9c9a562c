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
uniform float transition;          // [rest lengths] within which of a limit it comes into force

// The energy of a limit over its stiffness where a length is d past it. It comes into force from w
// before it to w past it, so that Newton's method meets no kinks.
float energy_past(float d, float w) {
    float part = clamp((d + w) * (0.5 / max(w, 1e-30)), 0.0, 1.0);
    float further = max(d - w, 0.0);
    return w * w * part * part * part / 1.5 + further * (w + 0.5 * further);
}

// The energy of an edge of length l, without damping [m2/s2].
float stored_energy(float l, int family, int rest) {
    float rest_l = rest_length[rest];
    float stretch = l - rest_l;
    float width = transition * rest_l;
    return 0.5 * edge_stiffness[rest] * stretch * stretch
        + limit_stiffness[rest] * (energy_past(l - longest[family] * rest_l, width)
            + energy_past(shortest[family] * rest_l - l, width));
}

// The pull of an edge [m/s2], and how much more it is for each metre more of length [1/s2].
struct Pull {
    float tension;
    float slope;
};

// Of an edge of length l, by the straight line that touches the law at the length judged. No more
// than one limit is in force there: they are further apart than their transitions are wide.
Pull pull_at(float l, float judged, float rate, int family, int rest) {
    float rest_l = rest_length[rest];
    float least = shortest[family] * rest_l;
    float most = longest[family] * rest_l;
    // A hard edge pulls and pushes at any length: all of its limit is always in force.
    bool is_hard = shortest[family] == longest[family];
    float width = is_hard ? 0.0 : transition * rest_l;
    float rise = is_hard ? 0.0 : 0.5 / max(width, 1e-30);
    float at_limit = is_hard ? 1.0 : 0.5;
    float side = judged > 0.5 * (least + most) ? 1.0 : -1.0;
    float beyond = side > 0.0 ? judged - most : least - judged;
    float slope = clamp(beyond * rise + at_limit, 0.0, 1.0);
    float past = side * (width * slope * slope + max(beyond - width, 0.0)) + slope * (l - judged);
    return Pull(
        edge_stiffness[rest] * (l - rest_l) + edge_damping[rest] * rate
            + limit_stiffness[rest] * past,
        edge_stiffness[rest] + limit_stiffness[rest] * slope);
}
