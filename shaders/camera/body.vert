// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The surface of a body.

#include "camera/pinhole.glsl"
#include "camera/solid.glsl"

uniform float lowered;  // how far below its surface a plane hides cloth [m]
out vec3 away;          // from the eye, in the world [m]
out vec3 normal;        // in the world

void main() {
    away = surface_place();
    normal = surface_normal();
    gl_Position = picture_matrix * vec4(away, 1.0);
    if (lowered > 0.0 && gl_Position.w > 0.0) {
        // At the same place of the picture, the depth of the plane that is lower.
        vec4 below = picture_matrix * vec4(away * (1.0 - lowered / dot(normal, away)), 1.0);
        gl_Position.z = below.z / below.w * gl_Position.w;
    }
}
