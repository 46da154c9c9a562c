// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Cloth as one sees it: a fabric of one colour, in checks, woven or knitted, in daylight, and a hem.
// WEAVE: how threads cross.

#include "render/nodes.glsl"
#include "render/hem.glsl"
#include "render/lamp.glsl"

uniform vec3 towards_camera;
uniform vec3 fabric_color;
#ifdef CHECKED
uniform vec2 check;          // sides of a check: columns, rows
uniform vec3 ground_color;   // of the threads between the coloured ones
#endif
#ifdef WOVEN
#define PLAIN_WEAVE 0
#define TWILL 1
#define KNIT 2
uniform vec2 thread;         // distance of threads or stitches: columns, rows
uniform vec3 ground_color;   // of the threads along a row
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

#ifdef WOVEN
const float PI = 3.14159265;

// A number from 0 to 1 for each thread, always the same one (PCG hash, Jarzynski and Olano 2020).
float yarn(int index) {
    uint state = uint(index) * 747796405u + 2891336453u;
    uint mixed = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return float(((mixed >> 22u) ^ mixed) >> 8u) / 16777216.0;
}

// The same, smooth from thread to thread.
float uneven(float at) {
    int below = int(floor(at));
    return mix(yarn(below), yarn(below + 1), smoothstep(0.0, 1.0, at - float(below)));
}

#if WEAVE == KNIT
// How high yarn stands within a cell from -0.5 to 0.5 of a jersey: stitches are Vs of two legs, two
// rows high, each of which holds the one below.
float relief_of(ivec2 crossing, vec2 within, out bool is_warp) {
    is_warp = true;
    float up = 0.5 * (within.y + 0.5);
    vec2 legs = (abs(within.x) - mix(vec2(0.04), vec2(0.46), vec2(up, up + 0.5))) / 0.13;
    return sqrt(max(1.0 - min(legs.x * legs.x, legs.y * legs.y), 0.0));
}
#else
// How high the thread on top of a crossing stands, within it from -0.5 to 0.5. In a plain weave
// those along columns and rows take turns; in a twill each warp passes over two threads and under one.
float relief_of(ivec2 crossing, vec2 within, out bool is_warp) {
    int place = (crossing.x + crossing.y) % (WEAVE == TWILL ? 3 : 2);
    is_warp = WEAVE == TWILL ? place != 0 : place == 0;
    float across = is_warp ? within.x : within.y, along = is_warp ? within.y : within.x;
    along = WEAVE == TWILL && is_warp ? 0.5 * (along + float(place) - 1.5) : along;
    // A thread is round, and bends down at either end.
    return cos(PI * across) * (0.7 + 0.3 * cos(2.0 * PI * along));
}
#endif

vec3 woven(vec2 threads) {
    ivec2 crossing = ivec2(floor(threads));
    bool is_warp;
    float relief = relief_of(crossing, fract(threads) - 0.5, is_warp);
    float slub = yarn(is_warp ? crossing.x : crossing.y + 8192) - 0.5;
    // Threads as small as pixels run together into their mean.
    vec2 width = fwidth(threads);
    float blur = smoothstep(0.05, 0.6, max(width.x, width.y));
    vec3 dyed = mix(is_warp ? fabric_color : ground_color, 0.5 * (fabric_color + ground_color), blur);
    float shade = mix(0.72 + 0.42 * relief + SLUB * slub, 0.97, blur);
    // Yarn is uneven: bands of several threads remain visible from farther away.
    vec2 bands = vec2(uneven(threads.x / BAND), uneven(threads.y / BAND + 4096.0)) - 0.5;
    return dyed * (shade + UNEVEN * (bands.x + bands.y));
}
#endif

void main() {
#ifdef CHECKED
    // Warp and weft cover each other by halves.
    vec2 share = coloured(0.5 * place / check);
    vec3 dyed = mix(ground_color, fabric_color, 0.5 * (share.x + share.y));
#elif defined(WOVEN)
    vec3 dyed = min(woven(place / thread), 1.0);
#else
    vec3 dyed = fabric_color;
#endif
    vec3 outward = normalize(gl_FrontFacing ? normal : -normal);
    color = vec4(
        daylight_on_cloth(dyed, point, outward, towards_camera) * (1.0 - hem(place)), 1.0);
}
