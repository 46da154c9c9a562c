// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The colour of a fabric at a place on it, given in metres of the cloth at rest.

#ifdef HAS_PATTERN
uniform vec3 second_color;
uniform float pitch;     // of checks, or of threads [m]
#endif

#if defined(PRINTED)
layout(binding = 3) uniform sampler2D fabric_print;  // its first line lies along row 0
uniform vec2 cloth_size;                              // along a row and along a column [m]

// Printed on one side alone, which has no colour of its own.
vec3 dye(vec3 own, vec2 at, bool is_front) {
    return is_front ? texture(fabric_print, at / cloth_size).rgb : own;
}
#elif defined(CHECKED)
// The share of coloured threads in one direction, smooth where a check is as small as a pixel.
vec2 coloured(vec2 at) {
    vec2 width = max(fwidth(at), vec2(1e-4));
    vec2 below = at - 0.5 * width, above = at + 0.5 * width;
    // Half of each period is coloured: the mean over a pixel is that of the integral.
    vec2 sum = 0.5 * (floor(above) - floor(below))
        + min(fract(above), 0.5) - min(fract(below), 0.5);
    return clamp(sum / width, 0.0, 1.0);
}

vec3 dye(vec3 own, vec2 at, bool is_front) {
    // Warp and weft cover each other by halves.
    vec2 share = coloured(0.5 * at / pitch);
    return mix(second_color, own, 0.5 * (share.x + share.y));
}
#elif defined(WOVEN)
const float PI = 3.14159265;

vec3 dye(vec3 own, vec2 at, bool is_front) {
    vec2 threads = at / pitch;
    ivec2 crossing = ivec2(floor(threads));
    vec2 within = fract(threads) - 0.5;
    // Plain weave: warp is on top of every other crossing.
    bool is_warp = ((crossing.x + crossing.y) & 1) == 0;
    float across = is_warp ? within.x : within.y, along = is_warp ? within.y : within.x;
    // A thread is round, and bends down at either end of the crossing.
    float light = cos(PI * across) * (0.75 + 0.25 * cos(2.0 * PI * along));
    // Where threads are as small as pixels they run together into their mean.
    float blur = clamp(max(fwidth(threads.x), fwidth(threads.y)) * 2.0 - 0.5, 0.0, 1.0);
    vec3 thread = mix(is_warp ? own : second_color, 0.5 * (own + second_color), blur);
    return thread * mix(0.55 + 0.45 * light, 0.76, blur);
}
#else
vec3 dye(vec3 own, vec2 at, bool is_front) {
    return own;
}
#endif
