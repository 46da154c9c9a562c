// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The surface of a body as the lamp sees it.

#include "camera/solid.glsl"

uniform mat4 lamp_matrix;  // clip coordinates of the lamp, for points relative to the eye

void main() {
    gl_Position = lamp_matrix * vec4(surface_place(), 1.0);
}
