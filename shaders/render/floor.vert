// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// A level square.

#include "render/view.glsl"

uniform vec3 middle;
uniform float reach;  // half a side [m]
out vec2 place;       // relative to the middle [m]
#ifdef DAYLIGHT
out vec3 point;
#endif

void main() {
    place = reach * (2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0);
#ifdef DAYLIGHT
    point = middle + vec3(place, 0.0);
#endif
    gl_Position = seen(middle + vec3(place, 0.0));
}
