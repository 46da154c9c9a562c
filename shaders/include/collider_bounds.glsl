// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Which colliders a node may come near to, by a sphere around each, or around the
// axis of a long one: cheap beside their distances.

#include "choose.glsl"
#include "read_first.glsl"

// The colliders that act on nodes by the law of contact.glsl, one bit each.
#ifndef NODE_COLLIDERS
#define NODE_COLLIDERS 0xffffffffu
#endif

#define SHAPE_PLANE 0
#define SHAPE_SPHERE 1
#define SHAPE_CAPSULE 2
#define SHAPE_BOX 3
#define SHAPE_CYLINDER 4

uniform float collider_shape[COLLIDERS];
#if OWN_BODIES
#include "own_bodies.glsl"
#else
uniform vec3 collider_axes[3 * COLLIDERS];  // x, y and z axis of each as the substep begins
uniform vec3 collider_centre[COLLIDERS];    // [m] as the substep begins
uniform float near_limit[COLLIDERS];        // [m] from the core that a node at rest is near
uniform float near_share[COLLIDERS];        // of that distance, with what it turns by

#if HAS_LONG
uniform vec3 near_core[COLLIDERS];          // half axis of a long one [m], or 0: the centre
#endif
#endif

// The first of some bodies.
int first_of(uint bodies) { return COLLIDERS > 1 ? findLSB(bodies) : 0; }

// What is read of uniforms of colliders, by body. Uniforms of a few are read before main() begins
// (read_first.glsl).
#if COLLIDERS <= 4
#define OF(READ, I) AT(READ, I)
#define ROW_OF(READ, ROW, I) CHOOSE(I, READ[ROW], READ[3 + ROW], READ[6 + ROW], READ[9 + ROW])
#define EACH_BODY(UNIFORM) FIRST_OF(UNIFORM[0], UNIFORM[1], UNIFORM[2], UNIFORM[3])
#define THREE(UNIFORM, FIRST) UNIFORM[FIRST], UNIFORM[FIRST + 1], UNIFORM[FIRST + 2]
#define ROWS_OF_EACH_BODY(UNIFORM) \
    FIRST_OF(THREE(UNIFORM, 0), THREE(UNIFORM, 3), THREE(UNIFORM, 6), THREE(UNIFORM, 9))
float body_shape[COLLIDERS] = float[](EACH_BODY(collider_shape));
#if OWN_BODIES
vec3 body_axes[3 * COLLIDERS];
vec3 body_centre[COLLIDERS];
float body_limit[COLLIDERS];
float body_share[COLLIDERS];
#if HAS_LONG
vec3 body_core[COLLIDERS];
#endif
#else
vec3 body_axes[3 * COLLIDERS] = vec3[](ROWS_OF_EACH_BODY(collider_axes));
vec3 body_centre[COLLIDERS] = vec3[](EACH_BODY(collider_centre));
float body_limit[COLLIDERS] = float[](EACH_BODY(near_limit));
float body_share[COLLIDERS] = float[](EACH_BODY(near_share));
#if HAS_LONG
vec3 body_core[COLLIDERS] = vec3[](EACH_BODY(near_core));
#endif
#endif
#elif OWN_BODIES
#define OF(READ, I) READ(I)
#define ROW_OF(READ, ROW, I) READ(ROW, I)
float body_shape(int i) { return collider_shape[i]; }
vec3 body_axes(int row, int i) { return own_entry(i, OWN_AXES + row).xyz; }
vec3 body_centre(int i) { return own_entry(i, OWN_CENTRE).xyz; }
float body_limit(int i) { return own_entry(i, OWN_CENTRE).w; }
float body_share(int i) { return own_entry(i, OWN_VELOCITY).w; }
vec3 body_core(int i) { return own_core(i); }
#else
#define OF(READ, I) READ[I]
#define ROW_OF(READ, ROW, I) READ[3 * (I) + ROW]
#define body_shape collider_shape
#define body_axes collider_axes
#define body_centre collider_centre
#define body_limit near_limit
#define body_share near_share
#define body_core near_core
#endif

#if OWN_BODIES
// Take where the bodies are of the cloth that the row of the stack belongs to.
void take_places(int row) {
    take_cloth(row);
#if COLLIDERS <= 4
    for (int i = 0; i < COLLIDERS; ++i) {
        body_centre[i] = own_entry(i, OWN_CENTRE).xyz;
        body_limit[i] = own_entry(i, OWN_CENTRE).w;
        body_share[i] = own_entry(i, OWN_VELOCITY).w;
#if HAS_LONG
        body_core[i] = own_core(i);
#endif
        for (int axis = 0; axis < 3; ++axis) {
            body_axes[3 * i + axis] = own_entry(i, OWN_AXES + axis).xyz;
        }
    }
#endif
}
#endif

// Min. distance that a point within radius of x has to travel to come near to a collider [m].
float least_way(int collider, vec3 x, float radius) {
    vec3 arm = x - OF(body_centre, collider);
    float l = length(arm);
    float away = OF(body_share, collider) * l;
#if HAS_LONG
    vec3 core = OF(body_core, collider);
    float place = clamp(dot(arm, core) / max(dot(core, core), 1e-30), -1.0, 1.0);
    away += length(arm - place * core) - l;
#endif
#if HAS_PLANE
    away = int(OF(body_shape, collider)) == SHAPE_PLANE
        ? dot(ROW_OF(body_axes, 2, collider), arm) - (l - away) : away;
#endif
    return away - (2.0 - OF(body_share, collider)) * radius - OF(body_limit, collider);
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

// Those among some bodies that a node may come near to: a few are faster looked at than picked.
uint near_among(uint bodies, vec3 x, float way) {
#if COLLIDERS <= 4
    return bodies & near_bodies(x, 0.0, way);
#else
    uint near = 0u;
    for (; bodies != 0u; bodies &= bodies - 1u) {
        int collider = first_of(bodies);
        near |= least_way(collider, x, 0.0) > way ? 0u : 1u << uint(collider);
    }
    return near;
#endif
}
