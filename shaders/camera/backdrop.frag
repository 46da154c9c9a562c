// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// A picture that fills the whole, behind everything.

layout(binding = 3) uniform sampler2D backdrop;
uniform vec2 picture_size;  // [pixel]
out vec4 color;

void main() {
    color = vec4(texture(backdrop, gl_FragCoord.xy / picture_size).rgb, 1.0);
}
