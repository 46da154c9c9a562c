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
