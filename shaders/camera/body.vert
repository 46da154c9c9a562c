// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The surface of a body.

#include "camera/pinhole.glsl"
#include "camera/solid.glsl"

uniform float behind;  // cloth is seen in front of what is nearer by less [m]
out vec3 away;         // from the eye, in the world [m]
out vec3 normal;       // in the world

void main() {
    away = surface_place();
    normal = surface_normal();
    vec4 here = picture_matrix * vec4(away, 1.0);
    vec4 farther = picture_matrix * vec4(away + behind * optical_axes[2], 1.0);
    gl_Position = vec4(here.xy, farther.z / farther.w * here.w, here.w);
    if (here.w <= 0.0) {
        gl_Position = here;
    }
}
