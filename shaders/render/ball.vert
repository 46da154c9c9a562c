// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Balls of one size in the picture: a square for each, in front of the cloth they stand on.

#include "render/view.glsl"

layout(binding = 0) uniform samplerBuffer places;
uniform float radius;  // [pixel]
uniform float lead;    // [m]
out vec2 place;        // from the middle, over the radius

void main() {
    place = (2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0) * (1.0 + 1.0 / radius);
    gl_Position = seen_in_front(texelFetch(places, gl_InstanceID).xyz, lead);
    gl_Position.xy += radius * place / half_size * gl_Position.w;
}
