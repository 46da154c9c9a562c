// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Tension of an edge over the node mass: see sim/solver/edge_law.py.

// Structural, shear, bend:
uniform float shortest[3];         // [rest lengths] below which the lower limit pulls
uniform float longest[3];          // [rest lengths] above which the upper one does
// Along a row, along a column, diagonal, two along each:
uniform float edge_stiffness[5];   // [1/s2]
uniform float edge_damping[5];     // [1/s]
uniform float limit_stiffness[5];  // [1/s2]
uniform float rest_length[5];      // [m]
uniform float transition;          // [rest lengths] half width of the onset of a limit
uniform bool judges_by_tension;

// Length that stands for no limit [rest lengths].
#define NO_LIMIT 1e29

// Energy of a limit over its stiffness at a length d past it [m2]. The onset is from -w to w, so
// that the tension has no kink for Newton's method.
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

// Length beyond the limits [m], positive if too long, and its derivative by the length [1]. Times
// limit_stiffness they are the tension of the limits and its slope.
struct Past {
    float amount;
    float slope;
};

// Length beyond the limits of an edge of length l, linearised at the length judged. At most one
// limit acts there: their distance exceeds the width of their transitions.
Past past_limits(float l, float judged, int family, int rest) {
    float rest_l = rest_length[rest];
    float least = shortest[family] * rest_l;
    float most = longest[family] * rest_l;
    // The limits of a hard edge coincide, and act at any length.
    bool is_hard = shortest[family] == longest[family];
    float width = is_hard ? 0.0 : transition * rest_l;
    float rise = is_hard ? 0.0 : 0.5 / max(width, 1e-30);
    float at_limit = is_hard ? 1.0 : 0.5;
    float side = judged > 0.5 * (least + most) ? 1.0 : -1.0;
    float beyond = side > 0.0 ? judged - most : least - judged;
    float slope = clamp(beyond * rise + at_limit, 0.0, 1.0);
    return Past(
        side * (width * slope * slope + max(beyond - width, 0.0)) + slope * (l - judged), slope);
}

// Tension of an edge over the node mass [m/s2], and its derivative by the length [1/s2].
struct Pull {
    float tension;
    float slope;
};

// As past_limits; rate is that of the length [m/s].
Pull pull_at(float l, float judged, float rate, int family, int rest) {
    Past past = past_limits(l, judged, family, rest);
    return Pull(
        edge_stiffness[rest] * (l - rest_length[rest]) + edge_damping[rest] * rate
            + limit_stiffness[rest] * past.amount,
        edge_stiffness[rest] + limit_stiffness[rest] * past.slope);
}

// Where to take the law for a straight line in the first solve of a pass: an edge that a limit
// pulls at is taken to be as long as its tension says. That changes little from pass to pass, and
// its length by as much as takes it in and out of the limit. Others are as long as expected.
// rate is that at which the tension was found.
float judged_length(float expected, float found, float rate, int family, int rest) {
    float rest_l = rest_length[rest];
    float width = transition * rest_l;
    float pull = found - edge_damping[rest] * rate;
    // A lower limit pushes.
    float side = pull > 0.0 ? 1.0 : -1.0;
    float limit = pull > 0.0 ? longest[family] : shortest[family];
    float reach = side * (limit - 1.0) * rest_l;
    float past = (abs(pull) - edge_stiffness[rest] * (reach - width)) / limit_stiffness[rest];
    float beyond = past < width ? 2.0 * sqrt(past * width) - width : past;
    // Bend edges may bend as far as they like.
    bool pulls = judges_by_tension && family != BEND && past > 0.0 && abs(limit) < NO_LIMIT;
    return pulls ? rest_l + side * (reach + beyond) : expected;
}
