// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Signed distances of the colliders, with their gradients: exact outside, and inside up to the
// nearest surface. Compiled for the shapes that the scene has.

#include "collider_bounds.glsl"

uniform vec3 collider_size[COLLIDERS];  // [m] radius and half the length, or half the sides
#if COLLIDERS <= 4
vec3 body_size[COLLIDERS] = vec3[](EACH_BODY(collider_size));
#elif OWN_BODIES
vec3 body_size(int i) { return collider_size[i]; }
#else
#define body_size collider_size
#endif

// Gradient and signed distance of the shape within radius of a core; p: vector from the core.
vec4 distance_to_core(vec3 p, float radius) {
    float l = length(p);
    return vec4(l > 0.0 ? p / l : vec3(0.0, 0.0, 1.0), l - radius);
}

// Normal and distance of a corner; q: distances from its surfaces, whose normals are x, y and z
// [m], negative inside.
vec4 distance_to_corner(vec3 q) {
    vec3 outside = max(q, 0.0);
    float l = length(outside);
    if (l > 0.0) {
        return vec4(outside / l, l);
    }
    if (q.x > q.y && q.x > q.z) {
        return vec4(1.0, 0.0, 0.0, q.x);
    }
    return q.y > q.z ? vec4(0.0, 1.0, 0.0, q.y) : vec4(0.0, 0.0, 1.0, q.z);
}

// Sign of p along each axis, 1 or -1.
vec3 side_of(vec3 p) { return mix(vec3(1.0), vec3(-1.0), lessThan(p, vec3(0.0))); }

vec4 distance_to_shape(int shape, vec3 size, vec3 p) {
#if HAS_SPHERE
    if (shape == SHAPE_SPHERE) {
        return distance_to_core(p, size.x);
    }
#endif
#if HAS_CAPSULE
    if (shape == SHAPE_CAPSULE) {
        return distance_to_core(p - vec3(0.0, 0.0, clamp(p.z, -size.y, size.y)), size.x);
    }
#endif
#if HAS_BOX
    if (shape == SHAPE_BOX) {
        vec4 found = distance_to_corner(abs(p) - size);
        return vec4(found.xyz * side_of(p), found.w);
    }
#endif
#if HAS_CYLINDER
    if (shape == SHAPE_CYLINDER) {
        float l = length(p.xy);
        vec2 outwards = l > 0.0 ? p.xy / l : vec2(1.0, 0.0);
        vec4 found = distance_to_corner(vec3(l - size.x, -1e9, abs(p.z) - size.y));
        return vec4(found.x * outwards, p.z < 0.0 ? -found.z : found.z, found.w);
    }
#endif
    return vec4(0.0, 0.0, 1.0, p.z);
}

// Normal and distance of the nearest surface, for a point at d from the centre.
vec4 distance_to_collider(int collider, vec3 d) {
    vec3 along_x = ROW_OF(body_axes, 0, collider);
    vec3 along_y = ROW_OF(body_axes, 1, collider);
    vec3 along_z = ROW_OF(body_axes, 2, collider);
    vec4 found = distance_to_shape(
        int(OF(body_shape, collider)), OF(body_size, collider),
        vec3(dot(along_x, d), dot(along_y, d), dot(along_z, d)));
    return vec4(found.x * along_x + found.y * along_y + found.z * along_z, found.w);
}
