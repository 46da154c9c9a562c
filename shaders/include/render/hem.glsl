// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The hem: how much darker the cloth is beside its border.

uniform int rows;
uniform float hem_width;   // [pixel]

#ifdef HAS_GAPS
// Distance from a border of the cell that is none [cell]: farther than any.
#define NOWHERE 2.0

bool is_beside_gap(ivec2 at) {
    return any(lessThan(at, ivec2(0))) || any(greaterThan(at, ivec2(cols, rows) - 2))
        || is_gap(at.y, at.x);
}

// Distances from the nearest borders at the side and above or below [cell].
vec2 border_distance(vec2 place) {
    ivec2 at = clamp(ivec2(place), ivec2(0), ivec2(cols, rows) - 2);
    vec2 within = place - vec2(at);
    return vec2(
        min(is_beside_gap(at - ivec2(1, 0)) ? within.x : NOWHERE,
            is_beside_gap(at + ivec2(1, 0)) ? 1.0 - within.x : NOWHERE),
        min(is_beside_gap(at - ivec2(0, 1)) ? within.y : NOWHERE,
            is_beside_gap(at + ivec2(0, 1)) ? 1.0 - within.y : NOWHERE));
}
#else
vec2 border_distance(vec2 place) { return min(place, vec2(cols - 1, rows - 1) - place); }
#endif

// Part of the light that the hem takes at a place, given as column and row.
float hem(vec2 place) {
    vec2 pixels = border_distance(place) / max(fwidth(place), vec2(1e-6));
    return HEM_SHADE * clamp(hem_width - min(pixels.x, pixels.y) + 0.5, 0.0, 1.0);
}
