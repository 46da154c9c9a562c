// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Forces of air on a triangle of the cloth, quadratic in the relative velocity of the air: drag along
// the normal, friction along the surface; docs/how_to/air.md.
// HAS_AIR_FRICTION: 0 leaves friction out.

uniform float drag;       // [1/m] rho Cn / (2 sigma), sigma the mass per area
uniform float friction;   // [1/m] rho Ct / (2 sigma)
uniform float lead;       // [s] half of what the acceleration acts for on a cloth that nothing holds,
                          // 0 on one that is held
uniform float most_rate;  // [1/s]

#if MEASURES_RATE
float fastest_rate = 0.0;  // [1/s] of those requested
#endif

// The acceleration over the velocity of the air past the cloth [1/s]; before: without the lead's
// share of an implicit step.
//
// A free cloth yields to the air, so that the velocity at the middle of the step is used, in closed
// form; a held one does not, so that the current velocity is. The rate is bounded such that the
// relative velocity does not change its sign. Both are stable for any step.
float rate(float before) {
#if MEASURES_RATE
    fastest_rate = max(fastest_rate, before);
#endif
    float left = 2.0 / (1.0 + sqrt(1.0 + 4.0 * lead * before));
    return min(left * left * before, most_rate);
}

// Acceleration [m/s2] of a triangle. area: its area vector over its area at rest;
// past: velocity of the air less that of the triangle, plus the part by the lead [m/s].
vec3 air_acceleration(vec3 area, vec3 past) {
    float square = dot(area, area);
    float across = dot(area, past);
    // No triangle, no normal.
    vec3 normal_part = area * (across / max(square, 1e-12));
    vec3 acceleration = rate(drag * abs(across)) * normal_part;
#if HAS_AIR_FRICTION
    vec3 along = past - normal_part;
    acceleration += rate(friction * sqrt(square * dot(along, along))) * along;
#endif
    return acceleration;
}
