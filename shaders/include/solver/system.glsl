// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Access to the system of all levels.

#include "symmetric.glsl"

#ifndef SYSTEM_ACCESS
#define SYSTEM_ACCESS
#endif
layout(std430, binding = SOLVER_SYSTEM) SYSTEM_ACCESS buffer System { vec4 system_data[]; };

#if LOADS_TEXTURE
layout(binding = SOLVER_SYSTEM) uniform samplerBuffer system_in;

vec4 load_system(int entry) { return texelFetch(system_in, entry); }
#else
vec4 load_system(int entry) { return system_data[entry]; }
#endif

Symmetric load_symmetric(int which, int field, int index) {
    return Symmetric(
        load_system(system_entry(which, field, index)).xyz,
        load_system(system_entry(which, field + 1, index)).xyz);
}

void store_symmetric(int which, int field, int index, Symmetric value) {
    system_data[system_entry(which, field, index)] = vec4(value[0], 0.0);
    system_data[system_entry(which, field + 1, index)] = vec4(value[1], 0.0);
}

Symmetric load_cloth_inverse(int index) {
    return Symmetric(
        load_system(cloth_entry(INVERSE, index)).xyz,
        load_system(cloth_entry(INVERSE + 1, index)).xyz);
}

vec3 times_inverse(int which, int index, vec3 v) {
    return times(load_symmetric(which, INVERSE, index), v);
}

#if HAS_SURFACE
// What contacts of edges and faces resist with at a node, no less than they do together.
Symmetric load_surface_ground(int index) {
    return Symmetric(
        load_system(cloth_entry(SURFACE_GROUND, index)).xyz,
        load_system(cloth_entry(SURFACE_GROUND + 1, index)).xyz);
}
#endif
