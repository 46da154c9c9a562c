// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// A floor in daylight that fades out.

#include "render/lamp.glsl"

uniform float reach;
uniform vec3 floor_color;
in vec2 place;
in vec3 point;
out vec4 color;

void main() {
    float fade = 1.0 - smoothstep(0.45, 1.0, length(place) / reach);
    color = vec4(daylight(floor_color, point, vec3(0.0, 0.0, 1.0)), fade);
}
