// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Cloth as one sees it: a fabric of one colour or in checks, in daylight, and a hem.

#include "render/nodes.glsl"
#include "render/hem.glsl"
#include "render/lamp.glsl"

uniform vec3 towards_camera;
uniform vec3 fabric_color;
#ifdef CHECKED
uniform vec2 check;          // sides of a check: columns, rows
uniform vec3 ground_color;   // of the threads between the coloured ones
#endif

in vec3 normal;
in vec2 place;
in vec3 point;
out vec4 color;

#ifdef CHECKED
// The share of coloured threads in one direction, smooth where a check is as small as a pixel.
vec2 coloured(vec2 at) {
    vec2 width = max(fwidth(at), vec2(1e-4));
    vec2 below = at - 0.5 * width, above = at + 0.5 * width;
    // Half of each period is coloured: the mean over a pixel is that of the integral.
    vec2 sum = 0.5 * (floor(above) - floor(below))
        + min(fract(above), 0.5) - min(fract(below), 0.5);
    return clamp(sum / width, 0.0, 1.0);
}
#endif

void main() {
#ifdef CHECKED
    // Warp and weft cover each other by halves.
    vec2 share = coloured(0.5 * place / check);
    vec3 dyed = mix(ground_color, fabric_color, 0.5 * (share.x + share.y));
#else
    vec3 dyed = fabric_color;
#endif
    vec3 outward = normalize(gl_FrontFacing ? normal : -normal);
    color = vec4(
        daylight_on_cloth(dyed, point, outward, towards_camera) * (1.0 - hem(place)), 1.0);
}
