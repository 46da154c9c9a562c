// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The surface of the cloth.

#include "camera/pinhole.glsl"
#include "camera/lattice.glsl"
#include "camera/corner.glsl"

out vec3 point;   // in the optical frame [m]
out vec3 away;    // from the eye, in the world [m]
out vec3 normal;  // in the world
out vec2 place;   // column and row

void main() {
    ivec2 corner = lattice_corner();
    vec3 here = node_at(corner.x, corner.y).xyz;
    away = from_eye(here);
    point = in_camera(away);
    normal = node_normal(here, corner.x, corner.y);
    place = vec2(corner.y, corner.x);
    gl_Position = picture_matrix * vec4(away, 1.0);
    if (is_corner_missing()) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    }
}
