// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// A body of one colour in daylight.

#include "camera/pinhole.glsl"
#include "render/lamp.glsl"

uniform vec3 body_color;
in vec3 away;
in vec3 normal;
out vec4 color;

void main() {
    if (1.0 / gl_FragCoord.w > pinhole[5]) {
        discard;
    }
    color = vec4(daylight(body_color, away, normalize(normal)), 1.0);
}
