// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// A body of one colour in daylight.

#include "camera/pinhole.glsl"
#include "render/lamp.glsl"
#ifdef WITHIN
#include "camera/ray.glsl"
#include "camera/dip.glsl"

uniform vec3 body_axes[3];  // in the world
uniform vec3 body_eye;      // the eye in the frame of the body [m]
#endif

uniform vec3 body_color;
in vec3 away;
in vec3 normal;
out vec4 color;

void main() {
    float depth = 1.0 / gl_FragCoord.w;
    if (depth > pinhole[5]) {
        discard;
    }
#ifdef WITHIN
    // What faces away, on a device where the picture is upside down and front faces are clockwise.
    if (gl_FrontFacing) {
        discard;
    }
    vec3 way = vec3(dot(body_axes[0], away), dot(body_axes[1], away), dot(body_axes[2], away));
    vec2 inside = WITHIN(body_eye, way, 0.0);
    // The middle of a pixel on the outline can be beside the body.
    gl_FragDepth = buffer_depth(
        inside.x < inside.y ? depth * hiding_from(body_eye, way, inside) : depth);
#endif
    color = vec4(daylight(body_color, away, normalize(normal)), 1.0);
}
