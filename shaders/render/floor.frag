// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Grid lines that fade out towards the end of the floor.

uniform float grid_step;    // [m]
uniform vec2 grid_offset;   // of the middle from a crossing [m]
uniform float reach;
uniform float line_width;   // [pixel]
uniform vec3 line_color;
in vec2 place;
out vec4 color;

void main() {
    vec2 cells = (place + grid_offset) / grid_step;
    vec2 pixel = max(fwidth(cells), vec2(1e-6));
    vec2 away = abs(cells - round(cells)) / pixel;
    vec2 sharp = clamp(0.5 * line_width + 0.5 - away, 0.0, 1.0);
    // Far away the lines run together into a tint.
    vec2 cover = mix(sharp, min(line_width * pixel, 1.0), smoothstep(0.2, 0.5, pixel));
    float fade = 1.0 - smoothstep(0.45, 1.0, length(place) / reach);
    color = vec4(line_color, max(cover.x, cover.y) * fade);
}
