// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// One colour under the light.

#include "render/light.glsl"

uniform vec3 arrow_color;
uniform float opacity;
in vec3 normal;
out vec4 color;

void main() {
    color = vec4(lit(arrow_color, normalize(normal), true), opacity);
}
