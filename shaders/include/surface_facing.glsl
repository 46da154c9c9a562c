// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// An edge or a face between a thin collider and another collider, as a node between two
// (find_compression in contact.glsl): where the gap between both is less than the thickness of the
// cloth, the contact point stays between them. Includer: surface_find.glsl.

// The collider that faces the collider of a row, or -1.
int facing_of(SurfaceRow row) { return int(row.impulse.w) - 2; }

// Fraction of the missing gap that a row leaves to the facing collider: half if that is thin and has
// rows of its own, otherwise all of it, as other colliders hold nodes exactly.
float part_of_row(int facing) {
    return (SURFACE_COLLIDERS >> uint(facing) & 1u) != 0u ? 0.5 : 1.0;
}

vec4 gap_of(int collider, vec3 x) {
    return is_at_end ? gap_at_end(collider, x, substep) : gap_at(collider, x);
}

// Gap between two surfaces at x [m]: at the end of the substep, and at the time of the row. normal:
// that of the first surface.
vec2 room_between(int collider, int facing, float gaps, vec3 normal, vec3 x) {
    float closing = is_at_end ? 0.0 : substep * dot(
        normal, surface_velocity(collider, x) - surface_velocity(facing, x));
    return vec2(gaps - closing, gaps);
}

// Find the facing collider that leaves the smallest gap at x, and adapt the row to it.
void find_facing(inout SurfaceRow row, int collider, vec3 x) {
    vec3 normal = row.normal.xyz;
    float gap = row.normal.w;
    float least = 0.0;
    for (int other = 0; other < COLLIDERS; ++other) {
        vec4 near = gap_of(other, x);
        if (other == collider
                || !are_facing(collider, other, normal, near.xyz, gap + near.w)) {
            continue;
        }
        vec3 n = normalize(normal - near.xyz);
        vec2 room = room_between(collider, other, gap + near.w, n, x);
        if (min(room.x, room.y) < least) {
            least = min(room.x, room.y);
            row.normal = vec4(n, gap - part_of_row(other) * min(room.y, 0.0));
            row.impulse.w = float(other + 2);
        }
    }
}

// Velocity at x of the surface of a row: its collider, or a plane between two facing ones.
vec3 carried_by(SurfaceRow row, vec3 x) {
    vec3 velocity = surface_velocity(int(row.weights.w), x);
    int facing = facing_of(row);
    if (facing >= 0) {
        float closing = dot(row.normal.xyz, velocity - surface_velocity(facing, x));
        velocity -= part_of_row(facing) * closing * row.normal.xyz;
    }
    return velocity;
}
