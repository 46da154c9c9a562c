// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The surface of the cloth as the lamp sees it.

#include "camera/pinhole.glsl"
#include "camera/lattice.glsl"
#include "camera/corner.glsl"

uniform mat4 lamp_matrix;  // clip coordinates of the lamp, for points relative to the eye

void main() {
    ivec2 corner = lattice_corner();
    gl_Position = lamp_matrix * vec4(from_eye(node_at(corner.x, corner.y).xyz), 1.0);
    if (is_corner_missing()) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    }
}
