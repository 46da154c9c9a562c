// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Find the contact of an edge or a face of the cloth with a thin collider. Includer: substep [s],
// vec4 load_begin(index): position of a node at the beginning of the substep, w as in state_in.glsl,
// vec3 load_end(index) and vec3 load_speed(index): position at the end, and velocity.

#include "surface_edges.glsl"
#include "surface_row.glsl"

// Min. weight of a node of a face [1]: a contact nearer to an edge belongs to the edge.
#define LEAST_WEIGHT 1e-5

bool is_at_end;  // whether rows use positions and colliders at the end of the substep
bool has_held = false;  // whether a row has acted before: then it cannot pass by the surface

vec3 place_of(int index) {
    return is_at_end ? load_end(index) : load_begin(index).xyz;
}

// Vector from the centre of the collider, rotated back to its axes at the beginning of the substep.
vec3 arm_of(int collider, vec3 x) {
    vec3 arm = x - collider_centre[collider];
    if (is_at_end) {
        arm -= substep * collider_velocity[collider];
        arm += substep * (arm.x * collider_turn[3 * collider]
            + arm.y * collider_turn[3 * collider + 1] + arm.z * collider_turn[3 * collider + 2]);
    }
    return arm;
}

vec3 turned_on(int collider, vec3 normal) {
    return is_at_end ? normal + substep * vec3(
        dot(collider_turn[3 * collider], normal), dot(collider_turn[3 * collider + 1], normal),
        dot(collider_turn[3 * collider + 2], normal)) : normal;
}

// Length of an edge at the end of the substep, from positions x at the beginning and velocities v.
float distance_at_end(int collider, vec3 a, vec3 b, vec3 va, vec3 vb) {
    bool was_at_end = is_at_end;
    is_at_end = true;
    vec3 arm_a = arm_of(collider, a + substep * va), arm_b = arm_of(collider, b + substep * vb);
    NearEdge found = nearest_on_edge(
        collider, arm_a, arm_b, distance_to_collider(collider, arm_a),
        distance_to_collider(collider, arm_b));
    is_at_end = was_at_end;
    return found.distance - clearance;
}

SurfaceRow no_row() { return SurfaceRow(vec4(0.0), vec4(0.0), vec4(0.0)); }

// Displacement of a node in the substep relative to a collider [m].
float way_of(int collider, int index) {
    return substep * length(load_speed(index) - surface_velocity(collider, place_of(index)));
}

// Max. gap of a contact of an edge [m]: the distance by which it may approach; at the end, only edges
// inside the collider count.
float edge_limit(int collider, int first, int second, float around) {
    return is_at_end ? -2.0 * around : max(way_of(collider, first), way_of(collider, second));
}

// The end of an edge: position, displacement as by way_of [m], vector from the centre of a collider
// [m], gradient of the distance to it, and distance [m].
struct EdgeEnd {
    vec3 place;
    float way;
    vec3 arm;
    vec4 near;
};

EdgeEnd edge_end(int collider, int index) {
    vec3 place = place_of(index);
    vec3 arm = arm_of(collider, place);
    return EdgeEnd(place, is_at_end ? 0.0 : way_of(collider, index), arm,
        distance_to_collider(collider, arm));
}

// Bound on the rounding of the slope of the distance along an edge, over its length [1]: with arms
// of 1 m and a body of 6 mm it is 1e-5.
#define LEVEL_SLOPE 1e-3

// Whether an edge may be near enough to touch, and nearer than at its ends. The distance is convex
// along it, so the tangents at both ends bound it from below.
bool may_edge_touch(int collider, EdgeEnd a, EdgeEnd b) {
    float around = rounding(a.place, collider);
    float limit = is_at_end ? -2.0 * around : max(a.way, b.way);
    vec3 along = b.arm - a.arm;
    float level = LEVEL_SLOPE * length(along);
    float first = dot(a.near.xyz, along) - level, last = dot(b.near.xyz, along) + level;
    bool is_between = first < 0.0 && last > 0.0;
    float place = clamp((b.near.w - a.near.w - last) / min(first - last, -1e-30), 0.0, 1.0);
    float least = a.near.w + first * place;
    return is_between && least - clearance <= limit + 2.0 * around;
}

// The contact of an edge that may touch.
SurfaceRow edge_row(int collider, int first, int second) {
    vec3 a = place_of(first), b = place_of(second);
    float around = rounding(a, collider);
    float limit = edge_limit(collider, first, second, around);
    vec3 arm_a = arm_of(collider, a), arm_b = arm_of(collider, b);
    vec4 at_a = distance_to_collider(collider, arm_a);
    vec4 at_b = distance_to_collider(collider, arm_b);
    NearEdge near = nearest_on_edge(collider, arm_a, arm_b, at_a, at_b);
    float gap = near.distance - clearance;
    bool is_near = near.place > 0.0 && near.place < 1.0 && gap < limit + around;
    // A contact at a node belongs to the node.
    is_near = is_near && near.distance < min(at_a.w, at_b.w) - around;
    float steep = length(near.slope);
    is_near = is_near && steep > 1e-6;
    if (is_near && !is_at_end && !has_held && gap > around && 2.0 * limit < collider_thickness[collider]) {
        is_near = distance_at_end(
            collider, a, b, load_speed(first), load_speed(second)) < 0.0;
    }
    if (!is_near) {
        return no_row();
    }
    vec3 normal = turned_on(collider, near.slope / steep);
    return SurfaceRow(
        vec4(normal, near.distance / steep - clearance), vec4(0.0, 0.0, 0.0, 1.0),
        vec4(1.0 - near.place, near.place, 0.0, float(collider)));
}

// The points of a collider that a face can touch, in its axes; normal: of the face.
vec3 tip_of(int shape, vec3 size, vec3 normal, int tip) {
    if (shape == SHAPE_CAPSULE) {
        return vec3(0.0, 0.0, tip == 0 ? -size.y : size.y);
    }
    if (shape == SHAPE_BOX) {
        return size * vec3((tip & 1) != 0 ? 1.0 : -1.0, (tip & 2) != 0 ? 1.0 : -1.0,
            (tip & 4) != 0 ? 1.0 : -1.0);
    }
    if (shape == SHAPE_CYLINDER) {
        float l = length(normal.xy);
        vec2 outwards = l > 1e-6 ? -normal.xy / l : vec2(1.0, 0.0);
        return vec3((tip & 2) != 0 ? -size.x * outwards : size.x * outwards,
            (tip & 1) != 0 ? size.y : -size.y);
    }
    return vec3(0.0);
}

// Depth of the point of core_of below a tip, along each axis [m].
float depth_of_core(int shape, vec3 size) {
    return shape == SHAPE_BOX ? min(size.x, min(size.y, size.z))
        : shape == SHAPE_CYLINDER ? min(size.x, size.y) : 0.0;
}

// A deepest point of a collider below a tip.
vec3 core_of(int shape, vec3 size, vec3 tip) {
    vec3 outwards = shape == SHAPE_BOX ? sign(tip)
        : vec3(tip.xy / max(length(tip.xy), 1e-30), sign(tip.z));
    return tip - depth_of_core(shape, size) * outwards;
}

int tip_count(int shape) {
    return shape == SHAPE_BOX ? 8 : shape == SHAPE_CYLINDER ? 4 : shape == SHAPE_CAPSULE ? 2 : 1;
}

// Whether a point, in the axes of a collider with tips, is inside it.
bool is_inside(int shape, vec3 size, vec3 x, float around) {
    return shape == SHAPE_CYLINDER
        ? length(x.xy) <= size.x + around && abs(x.z) <= size.y + around
        : all(lessThanEqual(abs(x), size + around));
}

float face_limit(int collider, ivec3 nodes, float around) {
    return is_at_end ? -2.0 * around : max(way_of(collider, nodes.x), max(
        way_of(collider, nodes.y), way_of(collider, nodes.z)));
}

// Whether a face, by its corners and the displacement of the fastest, is near enough to a point of
// the collider to touch it there.
bool may_face_touch(int collider, vec3 corners[3], float way, int tip) {
    int shape = int(collider_shape[collider]);
    vec3 size = collider_size[collider];
    // All possible points of a tip are within a radius of their middle.
    vec3 middle = tip_of(shape, size, vec3(0.0), tip);
    float radius = shape == SHAPE_BOX ? 0.0 : size.x;
    middle.xy = shape == SHAPE_CYLINDER ? vec2(0.0) : middle.xy;
    vec3 x0 = arm_of(collider, corners[0]);
    float reach = max(length(corners[1] - corners[0]), length(corners[2] - corners[0]));
    float around = rounding(corners[0], collider);
    vec3 away = middle.x * collider_axes[3 * collider]
        + middle.y * collider_axes[3 * collider + 1] + middle.z * collider_axes[3 * collider + 2] - x0;
    float limit = max((is_at_end ? -2.0 * around : way) + around, 0.0) + clearance;
    // A tip is at most as deep below the face as its core.
    float deepest = 2.0 * depth_of_core(shape, size);
    return tip < tip_count(shape) && length(away) <= reach + radius + max(limit, deepest);
}

// The contact of a face with a point of the collider.
SurfaceRow face_row(int collider, ivec3 nodes, int tip) {
    int shape = int(collider_shape[collider]);
    vec3 x0 = arm_of(collider, place_of(nodes.x));
    vec3 side = arm_of(collider, place_of(nodes.y)) - x0;
    vec3 other = arm_of(collider, place_of(nodes.z)) - x0;
    vec3 across = cross(side, other);
    float area = length(across);
    vec3 normal = across / max(area, 1e-30);
    bool is_round = shape == SHAPE_SPHERE || shape == SHAPE_CAPSULE;
    vec3 axis_x = collider_axes[3 * collider], axis_y = collider_axes[3 * collider + 1];
    vec3 axis_z = collider_axes[3 * collider + 2];
    vec3 size = collider_size[collider];
    // The side of the face is decided by a point deep inside the collider, which the face never
    // passes. The tips of a cylinder depend on the normal; opposite ones are separate tips.
    vec3 in_axes = vec3(dot(axis_x, normal), dot(axis_y, normal), dot(axis_z, normal));
    vec3 own = tip_of(shape, size, in_axes, tip);
    vec3 core = core_of(shape, size, own);
    core = core.x * axis_x + core.y * axis_y + core.z * axis_z;
    bool is_turned = dot(normal, x0 - core) > 0.0;
    normal = is_turned ? -normal : normal;
    vec3 place = own.x * axis_x + own.y * axis_y + own.z * axis_z - x0;
    float above = dot(normal, place);
    float gap = above - (is_round ? size.x : 0.0) - clearance;
    float around = rounding(place_of(nodes.x), collider);
    // Where a tip is through the face, its foot is inside the collider; a face beside the collider
    // may have a foot, too, up to the length of a side away.
    bool is_through = is_round || above >= 0.0
        || is_inside(shape, size, own - above * (is_turned ? -in_axes : in_axes), around);
    float limit = face_limit(collider, nodes, around);
    float scale = 1.0 / max(area * area, 1e-30);
    float second = dot(cross(place, other), across) * scale;
    float third = dot(cross(side, place), across) * scale;
    float least = min(min(second, third), 1.0 - second - third);
    float deepest = max(max(size.x, max(size.y, size.z)), clearance);
    bool is_near = area > 0.0 && least > LEAST_WEIGHT && is_through
        && gap < limit + around && gap > -2.0 * deepest;
    if (!is_near) {
        return no_row();
    }
    return SurfaceRow(
        vec4(turned_on(collider, -normal), gap), vec4(0.0, 0.0, 0.0, 1.0),
        vec4(1.0 - second - third, second, third, float(collider)));
}

// Whether the edge or face of a row exists at its node.
bool owns(int index, int row) {
    vec4 here = load_begin(index);
    if (row == 0) {
        return edge_share(here, load_begin(index + 1), EDGE_ROW) > 0.0;
    }
    if (row == 1) {
        return edge_share(here, load_begin(index + PITCH), EDGE_COLUMN) > 0.0;
    }
    return edge_share(here, load_begin(index + PITCH + 1), EDGE_DIAGONAL) > 0.0;
}

// The thin colliders that the cell of a node may reach.
uint colliders_near_cell(int index, uint bodies) {
    vec3 x = load_begin(index).xyz;
    ivec3 others = index + ivec3(1, PITCH, PITCH + 1);
    float reach = 0.0;
    for (int i = 0; i < 3; ++i) {
        vec4 other = load_begin(others[i]);
        // Ghost nodes have no position.
        if (other.w != 0.0) {
            reach = max(reach, length(other.xyz - x));
        }
    }
    uint near = 0u;
    for (bodies &= SURFACE_COLLIDERS; bodies != 0u; bodies &= bodies - 1u) {
        int collider = first_of(bodies);
        float way = length(load_speed(index) - surface_velocity(collider, x));
        for (int i = 0; i < 3; ++i) {
            vec4 other = load_begin(others[i]);
            way = max(way, other.w != 0.0 ? length(load_speed(others[i])
                - surface_velocity(collider, other.xyz)) : 0.0);
        }
        float away = distance_to_collider(collider, x - collider_centre[collider]).w - clearance;
        near |= away < reach + substep * way + 2.0 * rounding(x, collider)
            ? 1u << uint(collider) : 0u;
    }
    return near;
}
