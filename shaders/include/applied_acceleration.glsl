// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Acceleration that is not from springs: gravity, pushes and air.

uniform vec3 acceleration;         // [m/s2] gravity and pushes on the whole cloth
uniform bool has_region_pushes;    // something acts on nodes each by itself

// What acts on nodes each by itself [m/s2]: pushes on regions, and air; w: how many pushes act.
// Bound only while something does.
#if LOADS_TEXTURE
layout(binding = REGION_PUSHES) uniform samplerBuffer region_pushes;
vec4 load_region_pushes(int index) { return texelFetch(region_pushes, index); }
#else
layout(std430, binding = REGION_PUSHES) readonly buffer RegionPushes { vec4 region_pushes[]; };
vec4 load_region_pushes(int index) { return region_pushes[index]; }
#endif

vec3 applied_acceleration(int index) {
    vec3 applied = acceleration;
    if (has_region_pushes) {
        applied += load_region_pushes(index).xyz;
    }
    return applied;
}

bool is_pushed_in_region(int index) {
    return has_region_pushes && load_region_pushes(index).w > 0.0;
}
