// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Lines of one width in the picture: a quad around each piece from a point to the next.

#include "render/view.glsl"
#include "render/nodes.glsl"

uniform float half_width;              // [pixel]
out float strain;
noperspective out vec2 along;          // from the begin of the piece, and across it [pixel]
noperspective out float piece_length;  // [pixel]

void main() {
    vec4 begin = position_and_strain(gl_InstanceID);
    vec4 end = position_and_strain(gl_InstanceID + 1);
    vec4 a = seen(begin.xyz), b = seen(end.xyz);
    vec2 line = (b.xy / b.w - a.xy / a.w) * half_size;
    piece_length = length(line);
    vec2 forward = piece_length > 1e-3 ? line / piece_length : vec2(1.0, 0.0);
    float beyond = half_width + 1.0;
    bool is_end = (gl_VertexID & 1) == 1;
    float side = (gl_VertexID >> 1) == 1 ? beyond : -beyond;
    along = vec2(is_end ? piece_length + beyond : -beyond, side);
    strain = is_end ? end.w : begin.w;
    gl_Position = is_end ? b : a;
    vec2 shift = (is_end ? beyond : -beyond) * forward + side * vec2(-forward.y, forward.x);
    gl_Position.xy += shift / half_size * gl_Position.w;
}
