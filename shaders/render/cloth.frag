// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The colour of the cloth: its strain under the light, dots on nodes at their limit, and a hem.

#include "render/nodes.glsl"
#include "render/hem.glsl"
#include "render/light.glsl"
#include "render/strain_color.glsl"

uniform vec2 cell;         // sides of a cell at rest, the shorter one 1
uniform vec3 limit_color;

in vec3 normal;
in float strain;
in vec2 place;
out vec4 color;

#ifdef HAS_LIMITS
// How much of this pixel a dot on a node at its limit covers, with its rim and without.
vec2 limit_dot() {
    vec2 nearest = clamp(round(place), vec2(0.0), vec2(cols - 1, rows - 1));
    int flags = int(normal_and_flags(node_index(int(nearest.y), int(nearest.x))).w);
    if ((flags & FLAG_AT_LIMIT) == 0) {
        return vec2(0.0);
    }
    float away = length((place - nearest) * cell);
    vec2 across = fwidth(place) * cell;
    float pixel = 0.5 * (across.x + across.y);
    vec2 sharp = clamp(
        (vec2(DOT_RADIUS, DOT_INSIDE) - away) / max(pixel, 1e-6) + 0.5, vec2(0.0), vec2(1.0));
    // Where a cell is about as small as a pixel, a dot is a tint.
    return mix(sharp, vec2(0.0, DOT_TINT), smoothstep(0.25, 0.5, pixel));
}
#endif

void main() {
    vec3 shown = lit(strain_color(strain), normalize(normal), gl_FrontFacing);
#ifdef HAS_LIMITS
    vec2 covered = limit_dot();
    shown = mix(mix(shown, vec3(DOT_RIM), covered.x), limit_color, covered.y);
#endif
    color = vec4(shown * (1.0 - hem(place)), 1.0);
}
