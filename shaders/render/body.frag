// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// One colour in daylight.

#include "render/lamp.glsl"

uniform vec3 body_color;
in vec3 normal;
in vec3 point;
out vec4 color;

void main() {
    color = vec4(daylight(body_color, point, normalize(normal)), 1.0);
}
