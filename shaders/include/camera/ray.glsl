// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Where a ray from `eye` along `way` enters a body, in ways; 0 where it does not. The unit normal
// there points outwards. Each shape is that of include/collider_shapes.glsl.

uniform float size[3];  // lengths of the shape [m]

// What the pixel of the fragment looks along in the optical frame, per metre of depth.
vec3 pixel_ray() {
    vec2 pixel = gl_FragCoord.xy - 0.5;
    return vec3((pixel.x - pinhole[2]) / pinhole[0], (pixel.y - pinhole[3]) / pinhole[1], 1.0);
}

float meets_plane(vec3 from, vec3 way, out vec3 normal) {
    normal = vec3(0.0, 0.0, 1.0);
    return from.z > 0.0 && way.z < 0.0 ? -from.z / way.z : 0.0;
}

float meets_ball(vec3 from, vec3 way, float radius, out vec3 normal) {
    // From the point of the ray next to the middle: squares of far points would lose digits.
    float square = dot(way, way);
    float next = -dot(from, way) / square;
    vec3 aside = from + next * way;
    float half_chord = radius * radius - dot(aside, aside);
    float there = next - sqrt(max(half_chord, 0.0) / square);
    normal = (from + there * way) / radius;
    return half_chord > 0.0 && there > 0.0 ? there : 0.0;
}

float meets_sphere(vec3 from, vec3 way, out vec3 normal) {
    return meets_ball(from, way, size[0], normal);
}

// Where a ray is inside of two parallel planes at `half_length` from the middle.
vec2 between(float from, float way, float half_length) {
    float slope = abs(way) > 1e-20 ? way : 1e-20;
    vec2 ends = (vec2(-half_length, half_length) - from) / slope;
    return vec2(min(ends.x, ends.y), max(ends.x, ends.y));
}

// Where it is inside of an endless tube around z.
vec2 within_tube(vec3 from, vec3 way, float radius) {
    float square = max(dot(way.xy, way.xy), 1e-30);
    float next = -dot(from.xy, way.xy) / square;
    vec2 aside = from.xy + next * way.xy;
    float half_chord = radius * radius - dot(aside, aside);
    float reach = sqrt(max(half_chord, 0.0) / square);
    return half_chord > 0.0 ? vec2(next - reach, next + reach) : vec2(1.0, -1.0);
}

float meets_cylinder(vec3 from, vec3 way, out vec3 normal) {
    vec2 tube = within_tube(from, way, size[0]);
    vec2 caps = between(from.z, way.z, 0.5 * size[1]);
    float begin = max(tube.x, caps.x), end = min(tube.y, caps.y);
    normal = tube.x > caps.x
        ? vec3((from.xy + begin * way.xy) / size[0], 0.0) : vec3(0.0, 0.0, -sign(way.z));
    return begin < end && begin > 0.0 ? begin : 0.0;
}

float meets_capsule(vec3 from, vec3 way, out vec3 normal) {
    float half_length = 0.5 * size[1];
    vec2 tube = within_tube(from, way, size[0]);
    float found = 0.0;
    vec3 at = from + tube.x * way;
    if (tube.x < tube.y && tube.x > 0.0 && abs(at.z) <= half_length) {
        found = tube.x;
        normal = vec3(at.xy / size[0], 0.0);
    }
    for (int end = -1; end <= 1; end += 2) {
        vec3 outward;
        float there = meets_ball(
            from - vec3(0.0, 0.0, float(end) * half_length), way, size[0], outward);
        // The half of the ball that is inside of the tube is no surface.
        if (there > 0.0 && (found == 0.0 || there < found) && float(end) * outward.z >= 0.0) {
            found = there;
            normal = outward;
        }
    }
    return found;
}

float meets_box(vec3 from, vec3 way, out vec3 normal) {
    float begin = -1e30, end = 1e30;
    for (int axis = 0; axis < 3; ++axis) {
        vec2 sides = between(from[axis], way[axis], 0.5 * size[axis]);
        if (sides.x > begin) {
            begin = sides.x;
            normal = vec3(0.0);
            normal[axis] = -sign(way[axis]);
        }
        end = min(end, sides.y);
    }
    return begin < end && begin > 0.0 ? begin : 0.0;
}
