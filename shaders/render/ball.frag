// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// A ball with a light rim.

uniform float radius;
uniform float opacity;
uniform vec3 ball_color;
in vec2 place;
out vec4 color;

void main() {
    float away = length(place);
    float cover = clamp((1.0 - away) * radius + 0.5, 0.0, 1.0);
    if (cover == 0.0) {
        discard;
    }
    float rim = clamp((away - 1.0) * radius + min(RIM, 0.3 * radius) + 0.5, 0.0, 1.0);
    vec3 normal = vec3(place, sqrt(max(1.0 - away * away, 0.0)));
    float level = 0.7 + 0.45 * max(dot(normal, vec3(-0.45, 0.55, 0.70)), 0.0);
    color = vec4(mix(min(ball_color * level, 1.0), vec3(1.0), rim), opacity * cover);
}
