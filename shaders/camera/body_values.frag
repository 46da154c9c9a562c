// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Depth, label and normals of a body, exact for its shape: where the ray of the pixel meets it.

#include "camera/pinhole.glsl"
#include "camera/values.glsl"
#include "camera/ray.glsl"
#include "camera/dip.glsl"

uniform vec3 body_axes[3];  // in the optical frame
uniform vec3 body_eye;      // the eye in the frame of the body [m]

void main() {
    vec3 ray = pixel_ray();
    vec3 way = vec3(dot(body_axes[0], ray), dot(body_axes[1], ray), dot(body_axes[2], ray));
    vec2 inside = WITHIN(body_eye, way, 0.0);
    if (!(inside.x < inside.y && inside.x > 0.0)) {
        discard;
    }
    gl_FragDepth = buffer_depth(hiding_from(body_eye, way, inside));
    vec3 normal = OUTWARD(body_eye + inside.x * way);
    vec3 outward = normal.x * body_axes[0] + normal.y * body_axes[1] + normal.z * body_axes[2];
    write_values(inside.x * ray, outward, outward);
}
