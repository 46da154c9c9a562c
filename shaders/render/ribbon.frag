// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// A piece of a line with round ends.

#include "render/strain_color.glsl"

uniform float half_width;
uniform float rim;  // of darker colour [pixel]
uniform float opacity;
in float strain;
noperspective in vec2 along;
noperspective in float piece_length;
out vec4 color;

void main() {
    vec2 away = vec2(along.x - clamp(along.x, 0.0, piece_length), along.y);
    float inside = half_width - length(away);
    float cover = clamp(inside + 0.5, 0.0, 1.0);
    if (cover == 0.0) {
        discard;
    }
    float shade = rim > 0.0 ? 1.0 - HEM_SHADE * clamp(rim + 0.5 - inside, 0.0, 1.0) : 1.0;
    color = vec4(shade * strain_color(strain), opacity * cover);
}
