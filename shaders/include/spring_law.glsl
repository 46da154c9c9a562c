// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The three spring families and Hooke's law with damping along the spring (paper, Eq. 1).
// Families and rest lengths are numbered by sim/model/edge_kinds.py.

// Along a row, along a column, diagonal, two along each:
uniform float stiffness[5];    // [N/m]
uniform float damping[5];      // [N s/m]
uniform float rest_length[5];  // [m]

// Length of d and its inverse, finite for two nodes in one place.
vec2 length_and_inverse(vec3 d) {
    float square = max(dot(d, d), 1e-20);
    float inverse_length = inversesqrt(square);
    return vec2(square * inverse_length, inverse_length);
}

// Force on the node at the tail of d = x_j - x_i from the spring to j [N]; dv = v_j - v_i.
// share: of a whole line's stiffness, 0 where there is no edge (cells.glsl).
vec3 spring_force(vec3 d, vec3 dv, float share, int rest) {
    vec2 l = length_and_inverse(d);
    float pull = stiffness[rest] * (l.x - rest_length[rest]);
#if HAS_DAMPING
    pull += damping[rest] * dot(dv, d) * l.y;
#endif
    return (share * pull * l.y) * d;
}
