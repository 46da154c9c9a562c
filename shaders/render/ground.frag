// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// A plane that fades out with the grid on it.

uniform float reach;
uniform vec3 ground_color;
in vec2 place;
out vec4 color;

void main() {
    color = vec4(ground_color, 1.0 - smoothstep(0.45, 1.0, length(place) / reach));
}
