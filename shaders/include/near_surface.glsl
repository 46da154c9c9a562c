// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Thin colliders that a node, or an edge or face of it, may reach: by their distance, because the sphere
// around a long rod contains most of a cloth.

uniform float feature_reach;  // [m] max. distance of a node from a contact of its edge or face

// Bits of the bodies that are not thin, and of those near a node at x with velocity v.
uint near_surface(uint bodies, vec3 x, vec3 v, float h) {
    uint near = bodies & ~SURFACE_COLLIDERS;
    for (bodies &= SURFACE_COLLIDERS; bodies != 0u; bodies &= bodies - 1u) {
        int collider = first_of(bodies);
        float reach = feature_reach + clearance + h * length(v - surface_velocity(collider, x))
            + 2.0 * rounding(x, collider);
        // NaN counts as near.
        near |= distance_to_collider(collider, x - collider_centre[collider]).w > reach
            ? 0u : 1u << uint(collider);
    }
    return near;
}
