// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Symplectic Euler (paper, Eq. 3 and 4): v+ = v + h (a + F / m), x+ = x + h v+. A pinned node keeps
// its velocity, which is that of the pin.
// Velocities are those at the middle of substeps. The kick is the time between the middles of this
// substep and the one before; with h instead each change of h would add energy.

#include "low_parts.glsl"

uniform float substep;       // [s]
uniform float kick;          // [s] what forces act for: mean of this substep and the one before
uniform float inverse_mass;  // [1/kg] of what masses are over

vec3 next_velocity(int index, vec4 velocity, vec3 force, vec3 applied) {
#if HAS_CELLS
    vec3 change = kick * (applied + (velocity.w * inverse_mass) * force);
#else
    vec3 change = kick * (applied + inverse_mass * force);
#endif
    // Not times 0: a NaN would pass from a cloth by its ghosts to another one.
#if HAS_LOW_PARTS
    return changed_velocity(index, velocity.xyz, velocity.w > 0.0 ? change : vec3(0.0));
#else
    vec3 next = velocity.xyz + change;
    return velocity.w > 0.0 ? next : velocity.xyz;
#endif
}

vec3 next_position(int index, vec3 position, vec3 velocity) {
    return changed_position(index, position, substep * velocity);
}
