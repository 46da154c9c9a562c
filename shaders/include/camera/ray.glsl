// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Where a ray from a point along `way` is inside of a body, from and to, in ways; nowhere if the
// first is not below the second. The body is the one of include/collider_shapes.glsl with its
// surface moved inwards by `inset` [m]. `outward` is the unit normal at a point of its surface.

uniform float size[3];  // lengths of the shape [m]

const vec2 NOWHERE = vec2(1.0, -1.0);
const float ENDLESS = 1e30;

// What the pixel of the fragment looks along in the optical frame, per metre of depth.
vec3 pixel_ray() {
    vec2 pixel = gl_FragCoord.xy - 0.5;
    return vec3((pixel.x - pinhole[2]) / pinhole[0], (pixel.y - pinhole[3]) / pinhole[1], 1.0);
}

vec2 within_both(vec2 one, vec2 other) {
    return vec2(max(one.x, other.x), min(one.y, other.y));
}

// The same for two convex bodies that overlap.
vec2 within_either(vec2 one, vec2 other) {
    if (one.x >= one.y) {
        return other;
    }
    return other.x < other.y ? vec2(min(one.x, other.x), max(one.y, other.y)) : one;
}

vec2 within_ball(vec3 from, vec3 way, float radius) {
    // From the point of the ray next to the middle: squares of far points would lose digits.
    float square = dot(way, way);
    float next = -dot(from, way) / square;
    vec3 aside = from + next * way;
    float half_chord = radius * radius - dot(aside, aside);
    float reach = sqrt(max(half_chord, 0.0) / square);
    return half_chord > 0.0 ? vec2(next - reach, next + reach) : NOWHERE;
}

// Between two parallel planes at `half_length` from the middle.
vec2 between(float from, float way, float half_length) {
    float slope = abs(way) > 1e-20 ? way : 1e-20;
    vec2 ends = (vec2(-half_length, half_length) - from) / slope;
    return vec2(min(ends.x, ends.y), max(ends.x, ends.y));
}

// Within an endless tube around z.
vec2 within_tube(vec3 from, vec3 way, float radius) {
    float square = max(dot(way.xy, way.xy), 1e-30);
    float next = -dot(from.xy, way.xy) / square;
    vec2 aside = from.xy + next * way.xy;
    float half_chord = radius * radius - dot(aside, aside);
    float reach = sqrt(max(half_chord, 0.0) / square);
    return half_chord > 0.0 ? vec2(next - reach, next + reach) : NOWHERE;
}

// Below a plane, which is only seen from above.
vec2 within_plane(vec3 from, vec3 way, float inset) {
    return from.z > 0.0 && way.z < 0.0 ? vec2(-(from.z + inset) / way.z, ENDLESS) : NOWHERE;
}

vec3 outward_plane(vec3 point) { return vec3(0.0, 0.0, 1.0); }

vec2 within_sphere(vec3 from, vec3 way, float inset) {
    return within_ball(from, way, size[0] - inset);
}

vec3 outward_sphere(vec3 point) { return point / size[0]; }

vec2 within_cylinder(vec3 from, vec3 way, float inset) {
    return within_both(
        within_tube(from, way, size[0] - inset), between(from.z, way.z, 0.5 * size[1] - inset));
}

vec3 outward_cylinder(vec3 point) {
    float across = length(point.xy);
    return across - size[0] > abs(point.z) - 0.5 * size[1]
        ? vec3(point.xy / across, 0.0) : vec3(0.0, 0.0, sign(point.z));
}

vec2 within_capsule(vec3 from, vec3 way, float inset) {
    float half_length = 0.5 * size[1], radius = size[0] - inset;
    vec3 end = vec3(0.0, 0.0, half_length);
    vec2 middle = within_both(
        within_tube(from, way, radius), between(from.z, way.z, half_length));
    vec2 ends = within_either(
        within_ball(from - end, way, radius), within_ball(from + end, way, radius));
    return within_either(middle, ends);
}

vec3 outward_capsule(vec3 point) {
    float half_length = 0.5 * size[1];
    point.z -= clamp(point.z, -half_length, half_length);
    return point / size[0];
}

vec2 within_box(vec3 from, vec3 way, float inset) {
    vec2 inside = vec2(-ENDLESS, ENDLESS);
    for (int axis = 0; axis < 3; ++axis) {
        inside = within_both(inside, between(from[axis], way[axis], 0.5 * size[axis] - inset));
    }
    return inside;
}

vec3 outward_box(vec3 point) {
    vec3 beyond = abs(point) - 0.5 * vec3(size[0], size[1], size[2]);
    vec3 side = beyond.x > max(beyond.y, beyond.z) ? vec3(1.0, 0.0, 0.0)
        : beyond.y > beyond.z ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
    return side * sign(point);
}
