// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Depth, label and normals of the cloth.

#include "camera/pinhole.glsl"
#include "camera/values.glsl"

in vec3 point;
in vec3 normal;

void main() {
#ifdef HAS_NORMALS
    vec3 flat_normal = cross(dFdx(point), dFdy(point));
    float size = length(flat_normal);
    write_values(
        point, normalize(in_camera(normal)),
        size > 0.0 ? flat_normal / size : vec3(0.0, 0.0, -1.0));
#else
    write_values(point, vec3(0.0), vec3(0.0));
#endif
}
