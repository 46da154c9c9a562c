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
// A level square.

#include "render/view.glsl"

uniform vec3 middle;
uniform float reach;  // half a side [m]
out vec2 place;       // relative to the middle [m]

void main() {
    place = reach * (2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0);
    gl_Position = seen(middle + vec3(place, 0.0));
}
