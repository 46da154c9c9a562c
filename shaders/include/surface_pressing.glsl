// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Pressure of a thin collider and another one on a triangle of the cloth: `contact.compression` e,
// integrated over that part of it where both leave less room than the thickness of the cloth, so
// that the force does not depend on the size of a cell. The row acts at the centre of the pressure,
// and has no gap to keep: those of nodes, edges and faces do. Includer: surface_facing.glsl.

// Projections onto each collider [1]; chosen: parallel and crossed axes need one, others end nearer by
// the step of Newton's method.
#define PROJECTIONS 8
// Halvings of a length that is searched [1]: 12 locate its end to 2e-4 of the triangle.
#define HALVINGS 12
// Strips of the pressed part along and across it [1]: 8 x 8 add 1 % to the pressure of two spheres.
#define STRIPS 8
// Weight of the sides of a body in its curvature [1], for flat ones, which have none.
#define SIDES 0.01
// Gap of a row that keeps none [m].
#define FAR_GAP 1e9

uniform float node_area;  // [m2] of an inner node

// A triangle of the cloth.
struct Triangle {
    vec3 corners[3];
    vec3 normal;
    vec3 middle;
    float reach;  // of its corners from the middle [m]
};

Triangle triangle_at(ivec3 nodes) {
    Triangle found;
    found.corners = vec3[3](place_of(nodes.x), place_of(nodes.y), place_of(nodes.z));
    vec3 across = cross(
        found.corners[1] - found.corners[0], found.corners[2] - found.corners[0]);
    found.normal = across / max(length(across), 1e-30);
    found.middle = (found.corners[0] + found.corners[1] + found.corners[2]) / 3.0;
    found.reach = max(length(found.corners[0] - found.middle), max(
        length(found.corners[1] - found.middle), length(found.corners[2] - found.middle)));
    return found;
}

// The colliders that a thin one presses on triangles with, one bit each: of two thin ones only the
// first does. Loops over bits are not unrolled, which would compile all of this several times.
uint pressers_with(int collider) {
    uint before = (1u << uint(collider)) - 1u;
    return (1u << uint(COLLIDERS)) - 1u & ~(before | 1u << uint(collider))
        | before & ~SURFACE_COLLIDERS;
}

// By how much two colliders approach at x in the substep, along the normal of the first [m].
float closing_at(int collider, int other, vec3 normal, vec3 x) {
    return substep * dot(
        normal, surface_velocity(collider, x) - surface_velocity(other, x));
}

// Missing room at x as the substep begins [m]. It changes by at most 2 m a metre.
float lacking_at(int collider, int other, vec3 x) {
    return -gap_at(collider, x).w - gap_at(other, x).w;
}

// Whether there may be room missing within a triangle as the substep ends.
bool may_be_pressed(int collider, Triangle triangle) {
    float most = -1.0;
    for (uint rest = pressers_with(collider); rest != 0u; rest &= rest - 1u) {
        int other = first_of(rest);
        float closing = substep * length(surface_velocity(collider, triangle.middle)
            - surface_velocity(other, triangle.middle));
        float lacking = lacking_at(collider, other, triangle.middle);
        most = max(most, lacking + 2.0 * triangle.reach + closing);
    }
    return most > 0.0;
}

// Two colliders at a place between them in the plane of a triangle.
struct Pair {
    int other;       // the second; -1 for none
    vec3 x;
    vec3 normal;     // from the first to the second
    vec3 slope;      // gradient of the room [1]
    float lacking;   // missing room [m]
    float closing;   // by which they approach in the substep [m]
};

// The collider that leaves the least room together with this one, near the middle of the triangle.
Pair pressing_pair(int collider, Triangle triangle) {
    Pair found = Pair(-1, triangle.middle, triangle.normal, vec3(0.0), 0.0, 0.0);
    float own = min(0.5 * collider_thickness[collider], triangle.reach);
    float most = 0.0;
    for (uint rest = pressers_with(collider); rest != 0u; rest &= rest - 1u) {
        int other = first_of(rest);
        float others = min(0.5 * collider_thickness[other], triangle.reach);
        vec3 x = triangle.middle;
        for (int i = 0; i < PROJECTIONS; ++i) {
            // In turn onto surfaces inside both, since those with the cloth overlap.
            vec4 near = gap_at(other, x);
            x -= (near.w + others) * near.xyz;
            near = gap_at(collider, x);
            x -= (near.w + own) * near.xyz;
        }
        x -= dot(x - triangle.corners[0], triangle.normal) * triangle.normal;
        vec4 near = gap_at(collider, x), facing = gap_at(other, x);
        vec3 normal = near.xyz - facing.xyz;
        normal /= max(length(normal), 1e-30);
        float closing = closing_at(collider, other, normal, x);
        float lacking = -near.w - facing.w;
        float at_most = lacking + max(closing, 0.0);
        if (dot(near.xyz, facing.xyz) <= -FACING && at_most > most) {
            most = at_most;
            found = Pair(other, x, normal, near.xyz + facing.xyz, lacking, closing);
        }
    }
    return found;
}

// Tensor of the sides of a body in a plane, as xx, xy and yy of its axes.
vec3 sides_of(int collider, vec3 e1, vec3 e2) {
    int shape = int(collider_shape[collider]);
    vec3 size = collider_size[collider];
    size = shape == SHAPE_BOX ? size : vec3(size.x, size.x, size.x + size.y);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 3; ++i) {
        vec3 axis = collider_axes[3 * collider + i];
        vec2 along = vec2(dot(axis, e1), dot(axis, e2));
        sum += vec3(along.x * along.x, along.x * along.y, along.y * along.y)
            * (size[i] > 0.0 ? SIDES / size[i] : 0.0);
    }
    return sum;
}

// How the room of a pair bends in the plane of e1 and e2, as xx, xy and yy [1/m].
vec3 bent_in(int collider, Pair pair, vec3 e1, vec3 e2) {
    float way = max(0.5 * clearance, 1e-5);
    vec3 bent = vec3(0.0);
    // llvmpipe runs a branch for all rows, but skips a loop without rounds.
    int ends = pair.other >= 0 ? 4 : 0;
    int other = max(pair.other, 0);
    for (int i = 0; i < ends; ++i) {
        float side = (i & 1) == 0 ? 0.5 / way : -0.5 / way;
        vec3 x = pair.x + (i < 2 ? e1 : e2) * (side > 0.0 ? way : -way);
        vec3 slope = side * (gap_at(collider, x).xyz + gap_at(other, x).xyz);
        bent += i < 2 ? vec3(dot(slope, e1), 0.5 * dot(slope, e2), 0.0)
            : vec3(0.0, 0.5 * dot(slope, e1), dot(slope, e2));
    }
    return bent + sides_of(collider, e1, e2) + sides_of(other, e1, e2);
}

// How far from the place of a pair there is room missing within the triangle [m]: along one way,
// against it, across, and against that. Negative where all of the triangle is on the other side.
vec4 pressed_ends(int collider, Pair pair, Triangle triangle, vec3 along, vec3 across) {
    vec4 ends = vec4(0.0);
    int other = max(pair.other, 0);
    int sides = pair.other >= 0 ? 4 : 0;
    for (int i = 0; i < sides; ++i) {
        vec3 way = (i < 2 ? along : across) * ((i & 1) == 0 ? 1.0 : -1.0);
        float limit = max(dot(triangle.corners[0] - pair.x, way), max(
            dot(triangle.corners[1] - pair.x, way), dot(triangle.corners[2] - pair.x, way)));
        float begin = 0.0, end = max(limit, 0.0);
        int steps = limit > 0.0 ? HALVINGS : 0;
        for (int j = 0; j < steps; ++j) {
            float middle = 0.5 * (begin + end);
            bool is_pressed = lacking_at(
                collider, other, pair.x + middle * way) + pair.closing > 0.0;
            begin = is_pressed ? middle : begin;
            end = is_pressed ? end : middle;
        }
        ends += (limit > 0.0 ? end : limit) * vec4(equal(ivec4(i), ivec4(0, 1, 2, 3)));
    }
    return ends;
}

// What of the range is within the triangle, on a line from x along a way.
vec2 within_triangle(Triangle triangle, vec3 x, vec3 way, vec2 range) {
    for (int i = 0; i < 3; ++i) {
        vec3 corner = triangle.corners[i];
        vec3 inwards = cross(triangle.normal, triangle.corners[(i + 1) % 3] - corner);
        float from = dot(inwards, x - corner), slope = dot(inwards, way);
        bool is_parallel = abs(slope) < 1e-6 * length(inwards);
        float place = -from / (is_parallel ? 1.0 : slope);
        range = is_parallel ? vec2(range.x, from < 0.0 ? range.x : range.y)
            : slope > 0.0 ? vec2(max(range.x, place), range.y)
            : vec2(range.x, min(range.y, place));
    }
    return range;
}

// Integral of the compressed fraction over a triangle [m2]; moment: the same of its place [m3].
float compressed_area(int collider, Pair pair, Triangle triangle, out vec3 moment) {
    vec3 e1 = triangle.corners[1] - triangle.corners[0];
    e1 /= max(length(e1), 1e-30);
    vec3 e2 = cross(triangle.normal, e1);
    // Directions of greatest and of least curvature.
    vec3 bent = bent_in(collider, pair, e1, e2);
    float difference = bent.x - bent.z;
    float angle = abs(difference) + abs(bent.y) > 1e-9
        ? 0.5 * atan(2.0 * bent.y, difference) : 0.0;
    vec3 across = cos(angle) * e1 + sin(angle) * e2;
    vec3 along = cross(triangle.normal, across);
    // A step of Newton's method to the place of the least room.
    float mean = 0.5 * (bent.x + bent.z);
    float spread = length(vec2(0.5 * difference, bent.y));
    vec2 way = -vec2(dot(pair.slope, along), dot(pair.slope, across))
        / max(vec2(mean - spread, mean + spread), 1e-3);
    way = clamp(way, -triangle.reach, triangle.reach);
    vec3 nearer = pair.x + way.x * along + way.y * across;
    int other = max(pair.other, 0);
    float lacking_there = lacking_at(collider, other, nearer);
    pair.x = lacking_there > pair.lacking ? nearer : pair.x;
    bool is_pressed = max(lacking_there, pair.lacking) + pair.closing > 0.0;
    pair.other = is_pressed ? pair.other : -1;
    vec4 ends = pressed_ends(collider, pair, triangle, along, across);
    float width = (ends.x + ends.y) / float(STRIPS);
    float sum = 0.0;
    moment = vec3(0.0);
    int strips = pair.other >= 0 && width > 0.0 ? STRIPS : 0;
    for (int i = 0; i < strips; ++i) {
        vec3 from = (-ends.y + (float(i) + 0.5) * width) * along;
        vec2 part = within_triangle(triangle, pair.x + from, across, vec2(-ends.w, ends.z));
        float share = max(part.y - part.x, 0.0) / float(STRIPS);
        int points = share > 0.0 ? STRIPS : 0;
        for (int j = 0; j < points; ++j) {
            vec3 place = from + (part.x + (float(j) + 0.5) * share) * across;
            float lacking = lacking_at(collider, other, pair.x + place) + pair.closing;
            float compressed = share * width
                * clamp(lacking / max(2.0 * clearance, 1e-30), 0.0, 1.0);
            sum += compressed;
            moment += compressed * (pair.x + place);
        }
    }
    return sum;
}

// The row of the pressure on a triangle; press: change of velocity by it [m/s of an inner node].
SurfaceRow pressed_row(int collider, Triangle triangle, out float press) {
    Pair pair = pressing_pair(collider, triangle);
    vec3 moment;
    float area = compressed_area(collider, pair, triangle, moment);
    press = substep * compression * area / node_area;
    if (!(area > 0.0)) {
        press = 0.0;
        return no_row();
    }
    vec3 place = moment / area - triangle.corners[0];
    vec3 side = triangle.corners[1] - triangle.corners[0];
    vec3 third = triangle.corners[2] - triangle.corners[0];
    vec3 across = cross(side, third);
    float scale = 1.0 / max(dot(across, across), 1e-30);
    vec2 weights = clamp(scale * vec2(
        dot(cross(place, third), across), dot(cross(side, place), across)), 0.0, 1.0);
    return SurfaceRow(
        vec4(pair.normal, FAR_GAP), vec4(0.0, 0.0, 0.0, float(pair.other + 2)),
        vec4(1.0 - weights.x - weights.y, weights, float(collider)));
}
