// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// How long an edge will be at the end of the step without a change of its velocity u, along the
// direction n that it has now. A further solve begins where the nodes are at the end of the step:
// its u is 0.

uniform float substep;  // [s]

// By how much moving at u lengthens an edge of length l along n, besides substep dot(u, n).
float growth_by_turning(float l, vec3 n, vec3 u) {
    vec3 sideways = substep * (u - dot(u, n) * n);
    float square = dot(sideways, sideways);
    return square / (sqrt(l * l + square) + l);
}

float foreseen_length(float l, vec3 n, vec3 u) {
#if FORESEES_TURN
    return l + substep * dot(n, u) + growth_by_turning(l, n, u);
#else
    return l + substep * dot(n, u);
#endif
}
