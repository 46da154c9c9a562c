// Copyright 2026 the cloth_sim_ros authors
//
// Licensed under the Apache License, Version 2.0 (the "License");
// you may not use this file except in compliance with the License.
// You may obtain a copy of the License at
//
//     http://www.apache.org/licenses/LICENSE-2.0
//
// Unless required by applicable law or agreed to in writing, software
// distributed under the License is distributed on an "AS IS" BASIS,
// WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
// See the License for the specific language governing permissions and
// limitations under the License.

#version 430 core
// A piece of a line with round ends.

#include "render/strain_color.glsl"

uniform float half_width;
uniform float rim;  // of darker colour [pixel]
uniform float opacity;
in float strain;
noperspective in vec2 along;
noperspective in float piece_length;
out vec4 color;

void main() {
    vec2 away = vec2(along.x - clamp(along.x, 0.0, piece_length), along.y);
    float inside = half_width - length(away);
    float cover = clamp(inside + 0.5, 0.0, 1.0);
    if (cover == 0.0) {
        discard;
    }
    float shade = rim > 0.0 ? 1.0 - HEM_SHADE * clamp(rim + 0.5 - inside, 0.0, 1.0) : 1.0;
    color = vec4(shade * strain_color(strain), opacity * cover);
}
