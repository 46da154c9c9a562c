// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The fabric of the cloth in daylight: of one colour, in checks or woven, with another back.

#include "camera/pinhole.glsl"
#include "camera/lattice.glsl"
#include "camera/fabric.glsl"
#include "render/lamp.glsl"

uniform vec3 front_color;
uniform vec3 back_color;
uniform vec2 cell;         // sides of a cell at rest, along a row and along a column [m]

in vec3 away;    // from the eye, in the world [m]
in vec3 normal;  // in the world
in vec2 place;   // column and row
out vec4 color;

void main() {
    if (1.0 / gl_FragCoord.w > pinhole[5]) {
        discard;
    }
    // The picture is upside down on the device, where front faces are clockwise.
    bool is_front = !gl_FrontFacing;
    vec3 outward = normalize(is_front ? normal : -normal);
    vec3 dyed = dye(is_front ? front_color : back_color, place * cell, is_front);
    color = vec4(daylight_on_cloth(dyed, away, outward, -normalize(away)), 1.0);
}
