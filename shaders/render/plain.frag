// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// One colour.

uniform vec3 plain_color;
out vec4 color;

void main() {
    color = vec4(plain_color, 1.0);
}
