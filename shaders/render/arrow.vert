// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// An arrow: four rings around its axis (end, shaft, the back of the head, the head).

#include "render/view.glsl"

uniform vec3 tail;         // [m]
uniform vec3 tip;          // [m]
uniform float shaft;       // radius [m]
uniform float head;        // radius [m]
uniform float head_length; // [m]
out vec3 normal;

void main() {
    float total = distance(tail, tip);
    vec3 forward = (tip - tail) / total;
    vec3 other = abs(forward.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
    vec3 side = normalize(cross(forward, other));
    float angle = 6.283185307 * float(gl_VertexID >> 1) / float(SIDES);
    vec3 outward = cos(angle) * side + sin(angle) * cross(forward, side);
    float neck = total - head_length;
    // Distance along the axis and from it.
    vec2 profile[5] = vec2[5](
        vec2(0.0, 0.0), vec2(0.0, shaft), vec2(neck, shaft), vec2(neck, head), vec2(total, 0.0));
    vec2 at = profile[gl_InstanceID + (gl_VertexID & 1)];
    vec2 run = profile[gl_InstanceID + 1] - profile[gl_InstanceID];
    normal = normalize(run.x * outward - run.y * forward);
    gl_Position = seen(tail + at.x * forward + at.y * outward);
}
