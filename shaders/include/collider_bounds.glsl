// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Which colliders a node may come near to, by a sphere around each, or around the
// axis of a long one: cheap beside their distances.

#define SHAPE_PLANE 0
#define SHAPE_SPHERE 1
#define SHAPE_CAPSULE 2
#define SHAPE_BOX 3
#define SHAPE_CYLINDER 4

uniform float collider_shape[COLLIDERS];
uniform vec3 collider_axes[3 * COLLIDERS];  // x, y and z axis of each as the substep begins
uniform vec3 collider_centre[COLLIDERS];    // [m] as the substep begins
uniform float near_limit[COLLIDERS];        // [m] from the core that a node at rest is near
uniform float near_share[COLLIDERS];        // of that distance, with what it turns by

#if HAS_LONG
uniform vec3 near_core[COLLIDERS];          // half axis of a long one [m], or 0: the centre
#endif

// The first of some bodies: a constant where there is one, as llvmpipe reads an array of uniforms
// lane by lane otherwise.
int first_of(uint bodies) { return COLLIDERS > 1 ? findLSB(bodies) : 0; }

// Min. distance that a point within radius of x has to travel to come near to a collider [m].
float least_way(int collider, vec3 x, float radius) {
    vec3 arm = x - collider_centre[collider];
    float l = length(arm);
    float away = near_share[collider] * l;
#if HAS_LONG
    vec3 core = near_core[collider];
    float place = clamp(dot(arm, core) / max(dot(core, core), 1e-30), -1.0, 1.0);
    away += length(arm - place * core) - l;
#endif
#if HAS_PLANE
    away = int(collider_shape[collider]) == SHAPE_PLANE
        ? dot(collider_axes[3 * collider + 2], arm) - (l - away) : away;
#endif
    return away - (2.0 - near_share[collider]) * radius - near_limit[collider];
}

// The colliders that such a point may come near to within the distance way [m], one bit each; all
// if it is NaN.
uint near_bodies(vec3 x, float radius, float way) {
    uint bodies = 0u;
    for (int collider = 0; collider < COLLIDERS; ++collider) {
        bodies |= least_way(collider, x, radius) > way ? 0u : 1u << uint(collider);
    }
    return bodies;
}

// Those among some bodies that a node may come near to.
uint near_among(uint bodies, vec3 x, float way) {
    uint near = 0u;
    for (; bodies != 0u; bodies &= bodies - 1u) {
        int collider = first_of(bodies);
        near |= least_way(collider, x, 0.0) > way ? 0u : 1u << uint(collider);
    }
    return near;
}
